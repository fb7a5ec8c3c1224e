// One tree of a view as packed arrays.
#pragma once

#include <span>

#include "raygrain/view.h"

#include "report/view_blob.h"

namespace raygrain {

/// Arrays: `count` (triangles of each node, 0 for inner ones), `children` (of inner nodes, in the order of nodes),
/// `starts` (of leaves), `prims`, `measure`, `axis` (0 ... 2, 3 for leaves, + 4 where the fallback split, + 8 where it
/// was forced), `quality` of inner nodes, and `boxes` only where the boxes are not those of the triangles below.
ViewBlob pack_tree(const ViewTree& tree, std::span<const Bounds> triangles);

}  // namespace raygrain

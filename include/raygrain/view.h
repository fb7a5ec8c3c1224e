// Scene, influence areas and trees as one interactive page: what `raygrain view` writes.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "raygrain/build.h"
#include "raygrain/fields.h"
#include "raygrain/scene.h"
#include "raygrain/top_level.h"

namespace raygrain {

inline constexpr size_t kWholeScene = std::numeric_limits<size_t>::max();

/// A tree that the page can show. `tree` holds triangle ids of the scene's mesh.
struct ViewTree {
  std::string recipe;
  size_t area = kWholeScene;  // index into the scene's areas, or kWholeScene
  std::shared_ptr<const Bvh> tree;
  BuildLog log;        // may be empty: nothing is said then of axes and qualities
  RayMeasure measure;  // the tree's own: prices it in the page
  FieldValues values;  // what is known of it without rays; NaN where not
};

struct ViewOptions {
  uint64_t seed = 1;  // of the rays that the page casts at first
  CostModel costs;
  TopLevelOptions top_level;
};

/// One self-contained HTML file: the page (the text of a built viewer.html) filled with the scene's mesh, its areas,
/// the trees and the octree over the areas. Rays that are cast in it are those of cast_rays, and meet the same boxes
/// and triangles as analyze_rays counts: coordinates are stored bit for bit, boxes are computed anew from them or
/// stored. Only measures and qualities of nodes are rounded (to 16 bits). The same input gives the same bytes. Throws
/// Error: kMalformed (naming `path`) for a text that is no such page; kUsage for a tree of an area that is not there,
/// or without nodes.
std::string view_page(const Scene& scene, std::span<const ViewTree> trees, const ViewOptions& options,
                      const std::string& page, const std::string& path);

/// Is this the text of a page that view_page made?
bool is_view_page(const std::string& page);

}  // namespace raygrain

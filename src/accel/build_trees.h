// All trees of an accelerator, built side by side.
#pragma once

#include <vector>

#include "accel/search_tree.h"

namespace raygrain {

struct BuiltTrees {
  std::vector<LocalTree> locals;
  std::vector<SearchTree> local_searches;  // parallel to `locals`
  std::optional<SearchTree> global;
};

/// The mesh is kept by reference.
BuiltTrees build_trees(const TriangleMesh& mesh, std::span<const InfluenceArea> areas,
                       const AcceleratorOptions& options);

/// One per area, or none where options do not want them.
std::vector<Coverage> build_coverages(const std::shared_ptr<const TriangleMesh>& mesh,
                                      std::span<const InfluenceArea> areas, const AcceleratorOptions& options);

/// The form of a finished tree that rays are sent through.
SearchTree make_search_tree(const TriangleMesh& mesh, std::shared_ptr<const Bvh> binary, const RayMeasure& measure,
                            Traversal traversal, std::optional<Isa> isa = std::nullopt);

}  // namespace raygrain

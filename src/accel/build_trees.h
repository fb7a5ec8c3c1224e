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

/// The tree in the area's ray space over these triangles: in the frame that options name, or in the one of least
/// predicted cost, found on a subset. Nothing where no frame suits. `samples`: rays whose directions the measure is
/// made for; without any those within the area's tolerance.
std::optional<FrameTree> build_area_frame_tree(const InfluenceArea& area,
                                               const std::shared_ptr<const TriangleCorners>& corners,
                                               std::span<const uint32_t> triangles, std::span<const Ray> samples,
                                               const AcceleratorOptions& options);

/// One per area, or none where options do not want them.
std::vector<Coverage> build_coverages(const std::shared_ptr<const TriangleMesh>& mesh,
                                      std::span<const InfluenceArea> areas, const AcceleratorOptions& options);

/// The form of a finished tree that rays are sent through.
SearchTree make_search_tree(const TriangleMesh& mesh, std::shared_ptr<const Bvh> binary, const RayMeasure& measure,
                            Traversal traversal, std::optional<Isa> isa = std::nullopt, unsigned threads = 0);

}  // namespace raygrain

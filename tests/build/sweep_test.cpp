// build_sweep against a slow search over all positions.
#include <algorithm>
#include <limits>

#include "build/build_support.h"
#include "build/estimate.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

double slow_least_cost(const Prims& prims, const std::vector<uint32_t>& ids) {
  const RayMeasure measure;
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    for (const uint32_t at : ids) {
      Bounds left, right;
      double left_count = 0, right_count = 0;
      for (const uint32_t id : ids) {
        const bool is_left = prims.centroids[id][axis] < prims.centroids[at][axis];
        (is_left ? left : right).extend(prims.bounds[id]);
        (is_left ? left_count : right_count) += 1;
      }
      if (left_count == 0) continue;
      least = std::min(
          least, static_cast<double>(measure(left)) * left_count + static_cast<double>(measure(right)) * right_count);
    }
  return least;
}

std::vector<uint32_t> ids_below(const Bvh& bvh, uint32_t node) {
  std::vector<uint32_t> open{node}, ids;
  while (!open.empty()) {
    const Bvh::Node& at = bvh.nodes[open.back()];
    open.pop_back();
    if (at.is_leaf())
      ids.insert(ids.end(), bvh.prims.begin() + at.first, bvh.prims.begin() + at.first + at.count);
    else
      open.insert(open.end(), {at.first, at.first + 1});
  }
  return ids;
}

TEST(Sweep, EverySplitIsTheCheapestOfAll) {
  for (const NamedMesh& mesh : mesh_families(6)) {
    SCOPED_TRACE(mesh.name);
    const Prims prims = prims_of(mesh.mesh);
    const Bvh bvh = build_sweep(prims.bounds, prims.centroids, {}, nullptr);
    const RayMeasure measure;
    for (uint32_t i = 0; i < bvh.nodes.size(); ++i) {
      if (bvh.nodes[i].is_leaf()) continue;
      const double least = slow_least_cost(prims, ids_below(bvh, i));
      if (least == std::numeric_limits<double>::infinity()) continue;  // all centroids in one place
      double cost = 0;
      for (uint32_t child = bvh.nodes[i].first; child < bvh.nodes[i].first + 2; ++child)
        cost +=
            static_cast<double>(measure(bvh.nodes[child].bounds)) * static_cast<double>(ids_below(bvh, child).size());
      EXPECT_EQ(cost, least) << "node " << i;
    }
  }
}

TEST(Sweep, IsTheSameForAnyNumberOfThreads) {
  const Prims prims = random_prims(12000, 1);
  BuildOptions options;
  options.merge_leaves = true;
  options.threads = 1;
  const Bvh one = build_sweep(prims.bounds, prims.centroids, options, nullptr);
  EXPECT_EQ(find_defect(one, prims.bounds), std::nullopt);
  options.threads = 8;
  EXPECT_TRUE(same_tree(one, build_sweep(prims.bounds, prims.centroids, options, nullptr)));
  EXPECT_LT(estimated_cost(one, {}), 1.02 * estimated_cost(binned(prims, options), {}));
}

}  // namespace
}  // namespace raygrain::test

#include <gtest/gtest.h>

#include "raygrain/analyze.h"
#include "raygrain/rays.h"

#include "analyze/small_scenes.h"

namespace raygrain {
namespace {

Bvh two_leaves(const Bounds& left, const Bounds& right) {
  Bvh bvh;
  bvh.nodes = {test::inner_node(united(left, right), 1), test::leaf_node(left, 0, 1), test::leaf_node(right, 1, 1)};
  bvh.prims = {0, 1};
  return bvh;
}

TEST(Overlap, TwoRectanglesByHand) {
  const AreaGeometry sun(test::sun_over({0, 0, 1}, 50, 50));
  const Bvh bvh = two_leaves({{0, 0, 0}, {4, 2, 1}}, {{3, 0, 5}, {6, 3, 6}});  // share 1 x 2; areas 8 and 9
  const OverlapStats stats = analyze_overlap(bvh, sun);
  for (size_t i = 0; i < kOverlapLevels.size(); ++i) {
    EXPECT_NEAR(stats.plain[i], 2.0 / 8, 1e-9);
    EXPECT_NEAR(stats.culled[i], 2.0 / 8, 1e-9);
  }
}

TEST(Overlap, CulledCountsInTheWindowOnly) {
  const AreaGeometry sun(test::sun_over({0, 0, 1}, 50, 1));  // window: |y| <= 1
  const Bvh bvh = two_leaves({{0, 0, 0}, {4, 2, 1}}, {{3, -1, 5}, {9, 3, 6}});
  const OverlapStats stats = analyze_overlap(bvh, sun);
  EXPECT_NEAR(stats.plain[4], 2.0 / 8, 1e-9);   // 1 x 2 of min(4 x 2, 6 x 4)
  EXPECT_NEAR(stats.culled[4], 1.0 / 4, 1e-9);  // 1 x 1 of min(4 x 1, 6 x 2)
  const AreaGeometry away(test::sun_over({0, 0, 1}, 1, 1));
  EXPECT_NEAR(analyze_overlap(two_leaves({{2, 0, 0}, {3, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}), away).culled[4], 0, 1e-12);
}

TEST(Overlap, TouchingAndContainedSiblings) {
  const AreaGeometry sun(test::sun_over({0, 0, 1}, 50, 50));
  EXPECT_NEAR(analyze_overlap(two_leaves({{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}), sun).plain[4], 0, 1e-12);
  EXPECT_NEAR(analyze_overlap(two_leaves({{0, 0, 0}, {9, 9, 1}}, {{1, 1, 0}, {2, 2, 1}}), sun).plain[4], 1, 1e-12);
  EXPECT_EQ(analyze_overlap(two_leaves({{0, 0, 0}, {0, 1, 1}}, {{0, 0, 0}, {1, 1, 1}}), sun).plain[4], 0);
  EXPECT_EQ(analyze_overlap(Bvh{}, sun).plain[4], 0);
}

/// A chain whose inner node at level k has two children that share the part share(k) of the smaller.
Bvh chain(uint32_t levels, const std::function<float(uint32_t)>& share) {
  Bvh bvh;
  bvh.nodes.resize(2 * levels + 1);
  bvh.nodes[0].bounds = {{0, 0, 0}, {2, 1, 1}};
  for (uint32_t k = 0; k < levels; ++k) {
    const uint32_t inner = k == 0 ? 0 : 2 * k, first = 2 * k + 1;
    bvh.nodes[inner].first = first;
    bvh.nodes[first] = test::leaf_node({{0, 0, 0}, {1, 1, 1}}, k, 1);
    const float x = 1 - share(k);
    bvh.nodes[first + 1] = test::leaf_node({{x, 0, 0}, {x + 1, 1, 1}}, k + 1, 1);
    if (k + 1 < levels) bvh.nodes[first + 1].count = 0;
  }
  for (uint32_t i = 0; i <= levels; ++i) bvh.prims.push_back(i);
  return bvh;
}

TEST(Overlap, EachLevelCountsFromItsLevelOn) {
  const AreaGeometry sun(test::sun_over({0, 0, 1}, 50, 50));
  for (const uint32_t level : {0u, 4u, 5u, 7u, 8u, 10u, 11u, 15u, 16u, 119u}) {
    SCOPED_TRACE(level);
    const OverlapStats stats = analyze_overlap(chain(120, [&](uint32_t k) { return k == level ? 0.5f : 0.0f; }), sun);
    for (size_t i = 0; i < kOverlapLevels.size(); ++i) {
      const uint32_t last = i == 4 ? 119 : kOverlapLevels[i];  // the last entry stands for all levels
      EXPECT_NEAR(stats.plain[i], level <= last ? 0.5 / (last + 1) : 0, 1e-9) << i;
    }
  }
}

bool meets(const Ray& ray, const Bounds& box) {
  double enter = 0, leave = 1e30;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = static_cast<double>(ray.origin[axis]), d = static_cast<double>(ray.direction[axis]);
    double a = (static_cast<double>(box.lo[axis]) - o) / d, b = (static_cast<double>(box.hi[axis]) - o) / d;
    if (a > b) std::swap(a, b);
    enter = std::max(enter, a);
    leave = std::min(leave, b);
  }
  return enter <= leave;
}

/// A point of the projection lies in both hulls exactly when its ray meets both boxes: count rays of a fine grid.
TEST(Overlap, AgreesWithCountingRays) {
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto uniform = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
    const Vec3 direction{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const InfluenceArea area = seed % 2 ? test::sun_over(direction, 4, 3) : test::lamp_over(direction, 22, 17);
    const auto box = [&] {
      const Vec3 lo{uniform(-5, 2), uniform(-5, 2), uniform(-5, 2)};
      return Bounds{lo, lo + Vec3{uniform(1, 5), uniform(1, 5), uniform(1, 5)}};
    };
    const Bounds left = box(), right = box();
    double both = 0, only_left = 0, only_right = 0;
    for (const Ray& ray : window_grid_rays(area, 300, 300)) {
      const bool l = meets(ray, left), r = meets(ray, right);
      both += l && r;
      only_left += l;
      only_right += r;
    }
    const double smaller = std::min(only_left, only_right);
    const OverlapStats stats = analyze_overlap(two_leaves(left, right), AreaGeometry(area));
    if (smaller < 3000) continue;  // hardly in the window: the grid is too coarse
    EXPECT_NEAR(stats.culled[0], both / smaller, 0.02);
  }
}

}  // namespace
}  // namespace raygrain

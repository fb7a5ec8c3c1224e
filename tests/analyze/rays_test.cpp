#include "raygrain/rays.h"

#include <cstring>

#include <gtest/gtest.h>

#include "raygrain/analyze.h"

#include "analyze/small_scenes.h"

namespace raygrain {
namespace {

constexpr CostModel kCosts{.inner = 2, .triangle = 1};

/// Two leaves, one behind the other: triangles 0 and 1 at z = 1 and 2, triangle 2 at z = 5.
struct TwoLayers {
  TriangleMesh mesh;
  Bvh bvh;
};
TwoLayers two_layers() {
  TwoLayers scene;
  for (const float z : {1.0f, 2.0f, 5.0f}) test::add_triangle(scene.mesh, 0, 0, z);
  scene.bvh.nodes = {test::inner_node({{0, 0, 1}, {1, 1, 5}}, 1), test::leaf_node({{0, 0, 1}, {1, 1, 2}}, 0, 2),
                     test::leaf_node({{0, 0, 5}, {1, 1, 5}}, 2, 1)};
  scene.bvh.prims = {0, 1, 2};
  return scene;
}

TEST(AnalyzeRays, CountedByHand) {
  const TwoLayers scene = two_layers();
  const std::vector<Ray> rays{
      {{0.25f, 0.25f, 0}, {0, 0, 1}},           // meets both leaves, hits triangle 0; pruned: the first only
      {{0.75f, 0.75f, 0}, {0, 0, 1}},           // meets both boxes, misses all triangles
      {{2, 2, 0}, {0, 0, 1}},                   // misses the root: costs nothing
      {{0.25f, 0.25f, 3}, {0, 0, 1}},           // starts between the leaves: root and the far one
      {{0.25f, 0.25f, 0}, {0, 0, 1}, 0, 0.5f},  // ends before the root
      {{0.25f, 0.25f, 0}, {0, 0, 0}},           // invalid: a miss that costs nothing
  };
  const TraceStats stats = analyze_rays(scene.bvh, scene.mesh, rays, kCosts, 1);
  EXPECT_EQ(stats.rays, 6u);
  EXPECT_EQ(stats.hits, 2u);
  EXPECT_DOUBLE_EQ(stats.hit_ratio, 2.0 / 6);
  EXPECT_DOUBLE_EQ(stats.real_cost, (5.0 + 5 + 0 + 3 + 0 + 0) / 6);
  EXPECT_DOUBLE_EQ(stats.pruned_cost, (4.0 + 5 + 0 + 3 + 0 + 0) / 6);
  EXPECT_DOUBLE_EQ(stats.inner_hits, 3.0 / 6);
  EXPECT_DOUBLE_EQ(stats.leaf_hits, 5.0 / 6);
  EXPECT_DOUBLE_EQ(stats.leaf_triangles, 7.0 / 6);
  const double mean = 13.0 / 6, squares = 25 + 25 + 9;
  EXPECT_NEAR(stats.real_cost_deviation, std::sqrt((squares - 6 * mean * mean) / 5), 1e-12);
}

TEST(AnalyzeRays, NoRaysAndNoTriangles) {
  const TwoLayers scene = two_layers();
  EXPECT_EQ(analyze_rays(scene.bvh, scene.mesh, {}).real_cost, 0);
  const std::vector<Ray> rays{{{0, 0, 0}, {0, 0, 1}}};
  const TraceStats stats = analyze_rays(Bvh{}, TriangleMesh{}, rays);
  EXPECT_EQ(stats.real_cost, 0);
  EXPECT_EQ(stats.hits, 0u);
}

TEST(RayCost, UsesBothConstants) {
  const TraceCounters counters{.inner_hits = 3, .leaf_hits = 2, .leaf_triangles = 5};
  EXPECT_DOUBLE_EQ(ray_cost(counters, {.inner = 4, .triangle = 0.5f}), 12 + 2.5);
}

template <class Stats>
bool same_bytes(const Stats& a, const Stats& b) {
  static_assert(std::is_trivially_copyable_v<Stats>);
  return std::memcmp(&a, &b, sizeof(Stats)) == 0;
}

TEST(AnalyzeRays, ThreadsDoNotChangeABit) {
  const TriangleMesh mesh = test::random_triangles({{-9, -9, -9}, {9, 9, 9}}, 600, 1.5, 3);
  const Bvh bvh = build_global_tree(mesh, {"SAH", "ALL", "binned", {}}, default_registry());
  const InfluenceArea area = test::sun_over({1, -2, 0.5f}, 9, 9);
  const LocalTree local = build_local_tree(mesh, area, {"PAH", "ALL", "binned", {}}, default_registry());
  const std::vector<Ray> rays = cast_rays(AreaRays{.area = area}, 1234, 5);
  const TraceStats trace = analyze_rays(bvh, mesh, rays, {}, 1);
  const FallbackStats fallback = analyze_fallback(local, bvh, mesh, rays, {}, 1);
  EXPECT_GT(trace.real_cost, 0);
  EXPECT_GT(fallback.hit_ratio, 0);
  for (const unsigned threads : {1u, 2u, 8u, 0u}) {
    SCOPED_TRACE(threads);
    EXPECT_TRUE(same_bytes(analyze_rays(bvh, mesh, rays, {}, threads), trace));
    EXPECT_TRUE(same_bytes(analyze_fallback(local, bvh, mesh, rays, {}, threads), fallback));
  }
}

}  // namespace
}  // namespace raygrain

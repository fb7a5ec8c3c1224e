#include <gtest/gtest.h>

#include "raygrain/analyze.h"
#include "raygrain/rays.h"

#include "analyze/small_scenes.h"

namespace raygrain {
namespace {

TEST(BreakEven, MakesBothWaysCostTheSame) {
  for (const double local : {5.0, 20.0, 130.0}) {
    for (const double miss : {1.0, 40.0, 90.0}) {
      for (const double global : {10.0, 55.0, 100.0}) {
        const double h = break_even_hit_ratio(local, miss, global);
        EXPECT_NEAR(local + (1 - h) * miss, global, 1e-10);
      }
    }
  }
  EXPECT_TRUE(std::isnan(break_even_hit_ratio(5, 0, 10)));
}

/// The example of one triangle at z = 1 inside the area and one at z = 5 behind its end (z = 3).
struct Tunnel {
  TriangleMesh mesh;
  InfluenceArea area{"tunnel", PlaneArea{{0.5f, 0.5f, 0}, {0, 0, 1}, {0, 1, 0}, 1, 1, 3}};
  LocalTree local;
  Bvh global;
};
Tunnel tunnel() {
  Tunnel t;
  test::add_triangle(t.mesh, 0, 0, 1);
  test::add_triangle(t.mesh, 0, 0, 5);
  auto tree = std::make_shared<Bvh>();
  tree->nodes = {test::leaf_node({{0, 0, 1}, {1, 1, 1}}, 0, 1)};
  tree->prims = {0};
  t.local = {t.area, tree, {}, 0};
  t.global.nodes = {test::inner_node({{0, 0, 1}, {1, 1, 5}}, 1), test::leaf_node({{0, 0, 1}, {1, 1, 1}}, 0, 1),
                    test::leaf_node({{0, 0, 5}, {1, 1, 5}}, 1, 1)};
  t.global.prims = {0, 1};
  return t;
}

TEST(Fallback, CountedByHand) {
  const Tunnel t = tunnel();
  const std::vector<Ray> rays{
      {{0.25f, 0.25f, 0}, {0, 0, 1}},      // local hit: local 1, global 2 + 1 + 1
      {{0.75f, 0.75f, 0}, {0, 0, 1}},      // meets the boxes only: local 1, global 4
      {{1.25f, 1.25f, 0}, {0, 0, 1}},      // beside: nothing
      {{0.25f, 0.25f, 2}, {0, 0, 1}},      // starts behind the triangle: local 0, global 2 + 1
      {{0.25f, 0.25f, 0}, {0, 1, 1}},      // not the area's direction: global 0 (it leaves the box at z = 0.75)
      {{0.25f, 0.25f, 4}, {0, 0, 1}},      // starts outside: not served; global 3
      {{0.25f, 0.25f, 0}, {0, 0, 1}, -1},  // may hit behind its origin: never served; global 4
  };
  const FallbackStats stats = analyze_fallback(t.local, t.global, t.mesh, rays, {.inner = 2, .triangle = 1}, 1);
  EXPECT_EQ(stats.rays, 7u);
  EXPECT_EQ(stats.served, 4u);
  EXPECT_DOUBLE_EQ(stats.local_cost, (1.0 + 1 + 0 + 0) / 4);
  EXPECT_DOUBLE_EQ(stats.hit_ratio, 1.0 / 7);
  const double misses = 4.0 + 0 + 3 + 0 + 3 + 4;
  EXPECT_DOUBLE_EQ(stats.local_miss_cost, misses / 6);
  EXPECT_DOUBLE_EQ(stats.global_cost, (4 + misses) / 7);
  EXPECT_DOUBLE_EQ(stats.cost_with_fallback, (2 + misses) / 7);
  EXPECT_DOUBLE_EQ(stats.break_even, break_even_hit_ratio(2.0 / 7, misses / 6, (4 + misses) / 7));
}

TEST(Fallback, HitsBeyondTheExitDoNotCount) {
  Tunnel t = tunnel();
  auto both = std::make_shared<Bvh>(t.global);  // a triangle that overlaps the region may be hit behind it
  t.local.tree = both;
  const std::vector<Ray> rays{{{0.25f, 0.25f, 2}, {0, 0, 1}}};
  const FallbackStats stats = analyze_fallback(t.local, t.global, t.mesh, rays);
  EXPECT_EQ(stats.served, 1u);
  EXPECT_EQ(stats.hit_ratio, 0);
}

TEST(Fallback, NothingServedAndNoRays) {
  const Tunnel t = tunnel();
  EXPECT_EQ(analyze_fallback(t.local, t.global, t.mesh, {}).global_cost, 0);
  const std::vector<Ray> rays{{{0.25f, 0.25f, 4}, {0, 0, 1}}};
  const FallbackStats stats = analyze_fallback(t.local, t.global, t.mesh, rays);
  EXPECT_EQ(stats.local_cost, 0);
  EXPECT_EQ(stats.cost_with_fallback, stats.global_cost);
}

/// with fallback - global alone = (break-even - hit ratio) * cost of a miss, whatever the scene.
TEST(Fallback, BreakEvenIdentityOnRealTrees) {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = test::random_triangles({{-9, -9, -9}, {9, 9, 9}}, 100 * seed, 2, seed);
    const InfluenceArea area = seed % 2 ? test::sun_over({1, 2, 3}, 6, 5) : test::lamp_over({-1, 2, 1}, 20, 30);
    const Bvh global = build_global_tree(mesh, {"SAH", "ALL", "binned", {}}, default_registry());
    const LocalTree local = build_local_tree(mesh, area, {"PAH", "ALL", "binned", {}}, default_registry());
    AreaRays caster{.area = area};
    caster.cone_degrees = 12;  // some rays are not the area's
    const std::vector<Ray> rays = cast_rays(caster, 700, seed);
    const FallbackStats stats = analyze_fallback(local, global, mesh, rays);
    EXPECT_GT(stats.hit_ratio, 0);
    EXPECT_LT(stats.hit_ratio, 1);
    EXPECT_LT(stats.served, stats.rays);
    EXPECT_NEAR(stats.cost_with_fallback - stats.global_cost,
                (stats.break_even - stats.hit_ratio) * stats.local_miss_cost, 1e-9 * stats.global_cost);
    EXPECT_NEAR(stats.global_cost, analyze_rays(global, mesh, rays).real_cost, 1e-9 * stats.global_cost);
  }
}

}  // namespace
}  // namespace raygrain

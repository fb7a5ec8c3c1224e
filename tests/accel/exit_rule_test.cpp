// Scenes in which a search that stops too early, or trees that hold too little, would answer wrongly.
#include <string>

#include <gtest/gtest.h>

#include "accel/scenes.h"

namespace raygrain {
namespace {

using test::add_floor;
using test::add_triangle;
using test::border_points;
using test::with_costs;
using test::z_area;

/// Asserts that both searches agree with the oracle and returns what happened in `intersect`.
AcceleratorCounters check(const Accelerator& scene, const Ray& ray) {
  AcceleratorCounters counters;
  EXPECT_EQ(scene.intersect(ray, &counters), intersect_reference(scene.mesh(), ray));
  EXPECT_EQ(scene.occluded(ray), occluded_reference(scene.mesh(), ray));
  return counters;
}

/// Without coverage, which would answer most of these rays before any tree is asked, and with no choice by cost.
AcceleratorOptions trees_alone() {
  AcceleratorOptions options;
  options.coverage = std::nullopt;
  options.routing = Routing::kAreas;
  return options;
}

/// Membership as in programs that look at vertices only.
bool has_vertex_inside(const AreaGeometry& geometry, Vec3 a, Vec3 b, Vec3 c) {
  return contains(geometry.region(), a) || contains(geometry.region(), b) || contains(geometry.region(), c);
}

TEST(ExitRule, TrianglesWithoutVertexInTheRegionAreMembers) {
  TriangleMesh mesh;
  add_floor(mesh, 7, 0.1f);   // wholly inside the region
  add_floor(mesh, 5, 100.f);  // passes through it, no vertex inside
  const Ray ray{{0, 0, 0}, {0, 0, 1}};
  const Accelerator exact(mesh, {z_area("lamp", 0, 10)}, trees_alone());
  EXPECT_EQ(exact.local_trees()[0].tree->prims.size(), 2u);
  EXPECT_EQ(exact.intersect(ray).triangle, 1u);
  EXPECT_EQ(exact.intersect(ray).t, 5.0f);
  const AcceleratorCounters counters = check(exact, ray);
  EXPECT_EQ(counters.local_hits, 1u);
  EXPECT_EQ(counters.global_searches, 0u);

  // The injected rule changes the tree, and here the answer: the test can tell the difference.
  AcceleratorOptions options = trees_alone();
  options.membership = has_vertex_inside;
  const Accelerator vertex_only(mesh, {z_area("lamp", 0, 10)}, options);
  EXPECT_EQ(vertex_only.local_trees()[0].tree->prims, std::vector<uint32_t>{0});
  EXPECT_EQ(vertex_only.intersect(ray).triangle, 0u);
}

TEST(ExitRule, HitsBeyondTheExitDoNotCount) {
  TriangleMesh mesh;
  // Reaches from inside the region to far beyond it: a member, and met at t = 8, far below the region's far face.
  add_triangle(mesh, {0.5f, -1, 8}, {30, -50, 8}, {30, 50, 8});
  add_triangle(mesh, {-1, -1, 9.5f}, {1, -1, 9.5f}, {0, 1, 9.5f});
  // Beside the region, met at t = 4.
  add_triangle(mesh, {1.4f, -1, 4}, {4, -1, 4}, {1.4f, 2, 4});
  const Ray ray{{0, 0, 0}, {0.4f, 0, 1}};  // leaves through the side at t = 2.5
  const Accelerator scene(mesh, {z_area("lamp", 0, 10, 1, 0.2f)}, trees_alone());
  const LocalTree& local = scene.local_trees()[0];
  ASSERT_EQ(local.tree->prims.size(), 2u);
  ASSERT_EQ(intersect(*local.tree, mesh, ray).triangle, 0u);  // what stopping there would answer
  EXPECT_EQ(scene.intersect(ray).triangle, 2u);
  const AcceleratorCounters counters = check(scene, ray);
  EXPECT_EQ(counters.local_searches, 1u);
  EXPECT_EQ(counters.local_hits, 0u);
  EXPECT_EQ(counters.global_searches, 1u);
  // Any hit will do for a shadow ray, also one beyond the exit.
  AcceleratorCounters shadow;
  EXPECT_TRUE(scene.occluded(ray, &shadow));
  EXPECT_EQ(shadow.global_searches, 0u);
}

TEST(ExitRule, TiesAtTheExitGoToTheLowerIndex) {
  // Both triangles lie in the region's far face; the lower index is listed last in the region's neighbour as well.
  TriangleMesh mesh;
  add_floor(mesh, 4, 50);
  add_floor(mesh, 4, 0.1f);
  add_floor(mesh, 4, 50);
  for (const float depth : {4.f, std::nextafter(4.f, 0.f), std::nextafter(4.f, 9.f), 3.99999f, 4.00001f, 2.f}) {
    SCOPED_TRACE(depth);
    const Accelerator scene(mesh, {z_area("front", 0, depth), z_area("back", depth, 1)}, trees_alone());
    check(scene, {{0, 0, 0}, {0, 0, 1}});
    EXPECT_EQ(scene.intersect({{0, 0, 0}, {0, 0, 1}}).triangle, 0u);
  }
}

TEST(ExitRule, ChainOfAreasIsWalkedToTheHit) {
  for (const uint32_t hit_in : {0u, 1u, 4u, 9u}) {
    SCOPED_TRACE(hit_in);
    TriangleMesh mesh;
    std::vector<InfluenceArea> areas;
    for (uint32_t i = 0; i < 10; ++i) areas.push_back(z_area(std::to_string(i), static_cast<float>(i), 1));
    add_floor(mesh, 20, 1);
    add_floor(mesh, static_cast<float>(hit_in) + 0.5f, 1);
    const Accelerator scene(mesh, areas, trees_alone());
    const AcceleratorCounters counters = check(scene, {{0.25f, 0.25f, 0}, {0, 0, 1}});
    EXPECT_EQ(counters.local_searches, hit_in + 1);
    EXPECT_EQ(counters.continued, hit_in);
    EXPECT_EQ(counters.local_hits, 1u);
    EXPECT_EQ(counters.global_searches, 0u);
  }
}

TEST(ExitRule, GapsBetweenAreasAreNotSkipped) {
  TriangleMesh mesh;
  add_floor(mesh, 1.5f, 1);  // between the areas
  add_floor(mesh, 2.5f, 1);
  const Accelerator scene(mesh, {z_area("first", 0, 1), z_area("second", 2, 1)}, trees_alone());
  const AcceleratorCounters counters = check(scene, {{0, 0, 0}, {0, 0, 1}});
  EXPECT_EQ(counters.local_searches, 1u);
  EXPECT_EQ(counters.global_searches, 1u);
  EXPECT_EQ(scene.intersect({{0, 0, 0}, {0, 0, 1}}).triangle, 0u);
}

TEST(ExitRule, LongChainsEndInTheGlobalTree) {
  TriangleMesh mesh;
  std::vector<InfluenceArea> areas;
  for (uint32_t i = 0; i < 60; ++i) areas.push_back(z_area("", static_cast<float>(i), 1));
  for (uint32_t i = 0; i < 3; ++i) add_floor(mesh, 55.5f, 1);
  const Accelerator scene(mesh, areas, trees_alone());
  const AcceleratorCounters counters = check(scene, {{0, 0, 0}, {0, 0, 1}});
  EXPECT_GT(counters.local_searches, 8u);
  EXPECT_LT(counters.local_searches, 60u);
  EXPECT_EQ(counters.global_searches, 1u);
}

TEST(ExitRule, OverlappingAreasAreTriedByPredictedCost) {
  TriangleMesh mesh;
  add_floor(mesh, 6, 1);
  const std::vector<InfluenceArea> areas{z_area("short", 0, 2), z_area("middle", 0, 4), z_area("long", 0, 8)};
  const Ray ray{{0, 0, 0.5f}, {0, 0, 1}};
  const auto searches = [&](const std::vector<double>& costs) {
    return check(with_costs(mesh, areas, costs), ray).local_searches;
  };
  EXPECT_EQ(searches({3, 2, 1}), 1u);
  EXPECT_EQ(searches({1, 2, 3}), 3u);  // short, then middle, then long
  EXPECT_EQ(searches({2, 1, 3}), 2u);  // short ends before middle's exit
  EXPECT_EQ(searches({2, 2, 2}), 3u);  // ties: lower index
  EXPECT_EQ(searches({1, 3, 2}), 2u);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(searches({nan, nan, 5}), 1u);  // no number counts as the highest cost
}

TEST(ExitRule, AnAreaThatTouchesNothingAnswersForItsRegion) {
  TriangleMesh mesh;
  add_floor(mesh, 6, 1);
  const Accelerator scene(mesh, {z_area("empty", 0, 4)}, trees_alone());
  EXPECT_TRUE(scene.local_trees()[0].tree->nodes.empty());
  EXPECT_EQ(scene.local_trees()[0].predicted_cost, 0);
  EXPECT_EQ(check(scene, {{0, 0, 0}, {0, 0, 1}}).global_searches, 1u);
  EXPECT_EQ(check(scene, {{0, 0, 0}, {0, 0, 1}, 0, 3.5f}).global_searches, 0u);  // ends inside: a certain miss
  AcceleratorCounters shadow;
  EXPECT_FALSE(scene.occluded({{0, 0, 0}, {0, 0, 1}, 0, 3.5f}, &shadow));
  EXPECT_EQ(shadow.global_searches, 0u);
}

TEST(ExitRule, RangesOfTheRayAreKept) {
  TriangleMesh mesh;
  for (const float z : {-3.f, 1.f, 2.f, 3.f, 5.f, 9.f}) add_floor(mesh, z, 1);
  const Accelerator scene(mesh, {z_area("first", 0, 4), z_area("second", 4, 4)}, trees_alone());
  for (const float tmin : {-10.f, -3.f, -1e-30f, -0.f, 0.f, 1.f, 1.5f, 3.f, 4.f, 4.5f, 6.f, 9.f, 20.f})
    for (const float tmax : {-5.f, -0.f, 0.f, 0.5f, 1.f, 3.f, 4.f, 5.f, 8.f, 9.f, kInf}) {
      SCOPED_TRACE(std::to_string(tmin) + " ... " + std::to_string(tmax));
      for (const float z : {0.f, 1.f, 4.f, 5.f}) check(scene, {{0.1f, 0.2f, z}, {0, 0, 1}, tmin, tmax});
      const AcceleratorCounters counters = check(scene, {{0.1f, 0.2f, 0}, {0, 0, 1}, tmin, tmax});
      if (tmin < 0) {
        EXPECT_EQ(counters.local_searches, 0u);
      }
    }
}

TEST(ExitRule, RaysAgainstTheGrainAreServed) {
  TriangleMesh mesh;
  for (const float z : {-3.f, 1.f, 2.f, 3.f, 5.f}) add_floor(mesh, z, 1);
  const Accelerator scene(mesh, {z_area("lamp", 0, 4)}, trees_alone());
  const AcceleratorCounters counters = check(scene, {{0, 0, 4}, {0, 0, -2}});
  EXPECT_EQ(counters.local_hits, 1u);
  EXPECT_EQ(counters.global_searches, 0u);
}

TEST(ExitRule, ForeignAndInvalidRays) {
  TriangleMesh mesh;
  add_floor(mesh, 2, 1);
  const Accelerator scene(mesh, {z_area("lamp", 0, 4)}, trees_alone());
  AcceleratorCounters counters = check(scene, {{0, 0, 0}, {1, 0, 1}});  // 45 degrees off
  EXPECT_EQ(counters.areas_tested, 0u);  // no area has such a direction: none is looked up
  EXPECT_EQ(counters.areas_serving, 0u);
  EXPECT_EQ(counters.global_searches, 1u);
  counters = check(scene, {{0, 0, -5}, {0, 0, 1}});  // starts outside
  EXPECT_EQ(counters.areas_serving, 0u);

  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Ray invalid[] = {{{nan, 0, 0}, {0, 0, 1}},        {{0, 0, 0}, {0, 0, 0}},   {{0, 0, kInf}, {0, 0, -1}},
                         {{0, 0, 0}, {0, 0, kInf}},       {{0, 0, 0}, {nan, 0, 1}}, {{0, 0, 0}, {0, 0, 1}, nan, 1},
                         {{0, 0, 0}, {0, 0, 1}, 0.f, nan}};
  for (const Ray& ray : invalid) {
    counters = check(scene, ray);
    EXPECT_EQ(counters.rays, 1u);
    EXPECT_EQ(counters.invalid_rays, 1u);
    EXPECT_EQ(counters.areas_tested + counters.local_searches + counters.global_searches, 0u);
    EXPECT_FALSE(is_hit(scene.intersect(ray)));
    AcceleratorCounters shadow;
    EXPECT_FALSE(scene.occluded(ray, &shadow));
    EXPECT_EQ(shadow.invalid_rays, 1u);
  }
}

TEST(ExitRule, OriginsOnTheBorderAreInside) {
  const std::vector<InfluenceArea> areas{
      z_area("straight", -2, 4),
      {"turned", PlaneArea{{0.3f, -0.7f, 5.1f}, {0.3f, 1, -5}, {0, 1, 0}, 1.7f, 0.9f, 9.3f}},
      {"cone", PointArea{{0.3f, -0.7f, 5.1f}, {0.3f, 1, -5}, {0, 1, 0}, 40, 70, 0.5f, 9}},
      {"wide", PointArea{{1, 2, 3}, {-1, -2, -3.3f}, {0, 0, 1}, 150, 160, 0.01f, 6}}};
  TriangleMesh mesh;
  for (const float z : {-3.f, -1.f, 0.f, 1.f}) add_floor(mesh, z, 50);
  add_triangle(mesh, {-50, 0.1f, -50}, {50, 0.1f, -50}, {0, 0.3f, 80});
  add_triangle(mesh, {0.2f, -50, -50}, {0.2f, 50, -50}, {-0.1f, 1, 80});
  for (const InfluenceArea& area : areas) {
    SCOPED_TRACE(area.name);
    const AreaGeometry geometry(area);
    const Accelerator scene(mesh, {area}, trees_alone());
    uint64_t served = 0;
    for (const Vec3 origin : border_points(geometry.region()))
      for (const double sense : {1., -1.}) {
        const Ray ray{origin, to_float(geometry.ray_direction(to_double(origin)) * sense)};
        ASSERT_TRUE(geometry.serves(ray));
        served += check(scene, ray).areas_serving;
      }
    EXPECT_EQ(served, 54u);
  }
}

TEST(ExitRule, RaysAtThePointOfAPointArea) {
  TriangleMesh mesh;
  for (const float z : {1.f, 3.f, 9.f}) add_floor(mesh, z, 50);
  const InfluenceArea area{"eye", PointArea{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 60, 60, 0.5f, 5}};
  const Accelerator scene(mesh, {area}, trees_alone());
  // From the eye itself: outside the frustum, whose near face lies before it.
  EXPECT_EQ(check(scene, {{0, 0, 0}, {0.1f, 0.2f, 1}}).local_searches, 0u);
  EXPECT_EQ(check(scene, {{0.1f, 0.2f, 1}, {0.1f, 0.2f, 1}}).local_hits, 1u);
  // Towards the eye, as shadow rays go.
  EXPECT_EQ(check(scene, {{0.5f, 0.5f, 4}, {-0.5f, -0.5f, -4}, 0, 1}).local_hits, 1u);
}

TEST(ExitRule, OneAreaMayGoOnInOneOfAnotherKind) {
  TriangleMesh mesh;
  add_floor(mesh, 9, 1);
  const InfluenceArea camera{"camera", PointArea{{0, 0, -1}, {0, 0, 1}, {0, 1, 0}, 60, 60, 0.1f, 6}};
  const InfluenceArea sun = z_area("sun", 4, 8);
  const Accelerator scene(mesh, {sun, camera}, trees_alone());
  const AcceleratorCounters counters = check(scene, {{0, 0, 0}, {0, 0, 1}});
  EXPECT_EQ(counters.local_searches, 2u);
  EXPECT_EQ(counters.continued, 1u);
  EXPECT_EQ(counters.global_searches, 0u);
  // A ray that the second area does not serve where it would enter.
  const AcceleratorCounters slanted = check(scene, {{0.05f, 0, -0.9f}, {0.5f, 0, 1}});
  EXPECT_EQ(slanted.local_searches, 1u);
  EXPECT_EQ(slanted.global_searches, 1u);
}

TEST(ExitRule, FarAwayOriginsDoNotShiftTheExit) {
  // A huge first region, and a tiny second one at the origin: the point where the ray enters it, rounded to float,
  // says little about where the ray really is.
  TriangleMesh mesh;
  for (int i = -40; i <= 40; ++i) {
    const float x = static_cast<float>(i) * 0.03f;
    add_triangle(mesh, {x, -1, -0.5f}, {x + 0.01f, -1, -0.5f}, {x + 0.05f, 2, 0.7f});
    add_triangle(mesh, {x, -1, 0.4f}, {x + 0.02f, 1, 0.4f}, {x + 0.01f, 1, 0.45f});
  }
  const InfluenceArea huge{"huge", PlaneArea{{0, 0, -3e7f}, {0, 0, 1}, {0, 1, 0}, 10, 10, 3e7f}, 0.5f};
  const InfluenceArea tiny{"tiny", PlaneArea{{0, 0, -0.1f}, {0, 0, 1}, {0, 1, 0}, 0.1f, 0.1f, 2}, 0.5f};
  for (const auto& costs : {std::vector<double>{1, 2}, std::vector<double>{2, 1}}) {
    const Accelerator scene = with_costs(mesh, {huge, tiny}, costs);
    for (int i = -200; i <= 200; ++i) {
      const float x = static_cast<float>(i) * 0.01f;
      check(scene, {{x, 0.3f * x, -3e7f}, {-x * 3.3e-8f, 0, 1}});
      check(scene, {{x, 0, -2.9e7f}, {-x, 0.02f, 2.9e7f}});
    }
  }
}

}  // namespace
}  // namespace raygrain

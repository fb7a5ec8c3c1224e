// Single rays through accelerators with every kind of structure, against brute force; and what explain() says.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"
#include "raygrain/families.h"

#include "base/parallel.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"

namespace raygrain {
namespace {

using test::same_bits;

AcceleratorOptions options_of(LocalSpace space, bool covered, Routing routing = Routing::kAreas) {
  AcceleratorOptions options;
  options.space = space;
  options.routing = routing;
  if (!covered) options.coverage.reset();
  return options;
}

size_t rays_per_family() {
  const char* variable = std::getenv("RAYGRAIN_TEST_SCALE");
  const std::string scale = variable != nullptr ? variable : "";
  if (scale == "full") return 300'000;  // more than ten million over the families and options
  return scale == "small" ? 100 : 800;
}

TEST(Classification, EveryStructureEqualsBruteForce) {
  AcceleratorCounters all;
  const auto families = test::mesh_families(31);
  for (size_t f = 0; f < families.size(); ++f) {
    const TriangleMesh& mesh = families[f].mesh;
    const auto areas = areas_around(mesh, f + 3);
    std::vector<Ray> rays = rays_of_areas(mesh, areas, rays_per_family(), f);
    for (const Ray& ray : test::aimed_rays(mesh, rays_per_family() / 4, f)) rays.push_back(ray);
    std::vector<Hit> expected(rays.size());
    parallel_for(rays.size(), 64, 0, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) expected[i] = intersect_reference(mesh, rays[i]);
    });
    struct Way {
      LocalSpace space;
      bool covered;
      Routing routing;
    };
    constexpr Routing kAreas = Routing::kAreas, kCheapest = Routing::kCheapest;
    for (const auto& [space, covered, routing] :
         {Way{LocalSpace::kRay, false, kAreas}, Way{LocalSpace::kRay, true, kAreas},
          Way{LocalSpace::kWorld, true, kAreas}, Way{LocalSpace::kNone, true, kAreas},
          Way{LocalSpace::kRay, true, kCheapest}, Way{LocalSpace::kWorld, false, kCheapest}}) {
      const Accelerator scene(mesh, areas, options_of(space, covered, routing));
      AcceleratorCounters counters;
      std::vector<Hit> hits(rays.size());
      std::vector<uint8_t> flags(rays.size());
      scene.intersect(rays, hits);
      scene.occluded(rays, flags);
      for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same_bits(hits[i], expected[i])) << families[f].name << " ray " << i;
        ASSERT_EQ(flags[i] != 0, is_hit(expected[i])) << families[f].name << " ray " << i;
        ASSERT_TRUE(same_bits(scene.intersect(rays[i]), expected[i])) << families[f].name << " ray " << i;
        ASSERT_TRUE(same_bits(scene.intersect(rays[i], &counters), expected[i])) << families[f].name << " ray " << i;
        ASSERT_EQ(scene.occluded(rays[i]), is_hit(expected[i])) << families[f].name << " ray " << i;
        ASSERT_EQ(scene.occluded(rays[i], &counters), is_hit(expected[i])) << families[f].name << " ray " << i;
      }
      EXPECT_EQ(counters.rays, 2 * rays.size());
      EXPECT_LE(counters.columns + counters.cones, counters.local_searches);
      EXPECT_TRUE(covered || counters.covered == 0);
      EXPECT_TRUE(space == LocalSpace::kRay || counters.columns + counters.cones == 0);
      EXPECT_TRUE(space != LocalSpace::kNone || counters.local_searches == 0);
      all.add(counters);
    }
  }
  EXPECT_GT(all.covered, all.rays / 50);
  EXPECT_GT(all.columns, all.rays / 50);
  EXPECT_GT(all.cones, all.rays / 50);
}

// Two triangles overlap a narrow region and reach far beyond it: the area's tree is complete, its frame's domain is
// not.
TEST(Classification, RaysThatLeaveTheWindowFindTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{-10, 0, 5}, {10, 0, 5}, {0, 30, 5}, {-10, 0, 8}, {10, 0, 8}, {0, 30, 8}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const InfluenceArea narrow{"narrow", PlaneArea{{0, 5, 0}, {0, 0, 1}, {0, 1, 0}, 0.5f, 0.5f, 10}, 0.3f};
  for (const LocalSpace space : {LocalSpace::kWorld, LocalSpace::kRay}) {
    const Accelerator scene(mesh, {narrow}, options_of(space, false));
    for (int i = 0; i < 200; ++i) {
      const auto lean = static_cast<float>(i - 100) * 0.006f;
      const Ray ray{{0.2f, 5, 0}, {lean, 0.5f * lean, 1}};
      ASSERT_TRUE(same_bits(scene.intersect(ray), intersect_reference(mesh, ray))) << i;
      ASSERT_EQ(scene.occluded(ray), occluded_reference(mesh, ray)) << i;
    }
  }
}

TEST(Classification, AGivenFrameIsTaken) {
  const TriangleMesh mesh = test::mesh_families(2).front().mesh;
  const InfluenceArea sun = directional_light_area("sun", {0.5f, -0.7f, 0.5f}, mesh_bounds(mesh));
  for (const FrameKind kind : {FrameKind::kRotation, FrameKind::kShearX, FrameKind::kShearY, FrameKind::kShearZ}) {
    AcceleratorOptions options = options_of(LocalSpace::kRay, false);
    options.frame = kind;
    const Accelerator scene(mesh, {sun}, options);
    ASSERT_TRUE(scene.local_trees()[0].in_ray_space.has_value());
    EXPECT_EQ(scene.local_trees()[0].in_ray_space->frame().kind, kind);
  }
  // A box with axis-parallel faces: a shear keeps them thin, the rotation does not.
  const Accelerator chosen(mesh, {sun}, options_of(LocalSpace::kRay, false));
  EXPECT_NE(chosen.local_trees()[0].in_ray_space->frame().kind, FrameKind::kRotation);
  EXPECT_GT(chosen.wide_memory_bytes(),
            Accelerator(mesh, {sun}, options_of(LocalSpace::kWorld, false)).wide_memory_bytes());
}

/// The number behind `label` in the line that begins with `kind`.
double predicted(const std::string& routes, const std::string& kind, const std::string& label) {
  const size_t line = routes.find(kind + ": "), at = routes.find(label + " ", line);
  EXPECT_TRUE(line != std::string::npos && at < routes.find('\n', line)) << kind << ", " << label << "\n" << routes;
  return at == std::string::npos ? -1 : std::stod(routes.substr(at + label.size() + 1));
}

// Of arrays coverage is asked about in batches, at a share of what it costs alone: that is what is compared.
TEST(Classification, PredictsOfArraysWhatTheChoiceCompares) {
  const TriangleMesh mesh = test::mesh_families(2).front().mesh;
  const InfluenceArea sun = directional_light_area("sun", {0.5f, -0.7f, 0.5f}, mesh_bounds(mesh));
  AcceleratorOptions options;
  options.space = LocalSpace::kNone;
  const std::string routes = Accelerator(mesh, {sun}, options).explain({}, 10).areas[0].routes;
  for (const std::string kind : {"any hit", "closest hit"}) {
    const double alone = predicted(routes, kind, "along it: coverage");
    const double batch = predicted(routes, kind + " in arrays", "along it: coverage in batches");
    EXPECT_NEAR(batch, 0.4 * alone, 0.71) << routes;  // both are rounded
    const double global = predicted(routes, kind + " in arrays", ", global");
    const bool is_chosen = routes.find(kind + " in arrays: along it coverage") != std::string::npos;
    EXPECT_TRUE(is_chosen ? batch <= global + 1 : batch >= global - 1) << routes;
  }
}

/// Equal builds choose alike, say so, and keep what they use.
TEST(Classification, RoutesAreChosenByCountedCost) {
  const TriangleMesh mesh = test::mesh_families(2).front().mesh;
  const InfluenceArea sun = directional_light_area("sun", {0.5f, -0.7f, 0.5f}, mesh_bounds(mesh));
  const Accelerator scene(mesh, {sun}, options_of(LocalSpace::kRay, true, Routing::kCheapest));
  const Accelerator again(mesh, {sun}, options_of(LocalSpace::kRay, true, Routing::kCheapest));
  const std::string routes = scene.explain({}, 10).areas[0].routes;
  EXPECT_EQ(routes, again.explain({}, 10).areas[0].routes);
  EXPECT_NE(routes.find("predicted ns"), std::string::npos) << routes;
  EXPECT_EQ(std::ranges::count(routes, '\n'), 4) << routes;

  // A local tree that the global one beats is not searched, and keeps no fast form.
  Ray near_axis{{0, 0, 0}, {-0.5f, 0.7f, -0.52f}};
  AcceleratorCounters counters;
  scene.occluded(near_axis, &counters);
  const bool searches = routes.find("any hit: along it coverage, near it its tree") == 0;
  EXPECT_EQ(counters.local_searches, searches ? 1u : 0u) << routes;
  const Accelerator without(mesh, {sun}, options_of(LocalSpace::kNone, true, Routing::kCheapest));
  EXPECT_TRUE(without.local_trees().empty());
  EXPECT_LT(without.memory_bytes(), scene.memory_bytes());
  EXPECT_EQ(without.explain({}, 10).areas[0].structures, "coverage");
}

TEST(Classification, ExplainsItself) {
  const TriangleMesh mesh = test::mesh_families(2).front().mesh;
  const InfluenceArea sun = directional_light_area("sun", {0.5f, -0.7f, 0.5f}, mesh_bounds(mesh));
  const Accelerator scene(mesh, {sun}, options_of(LocalSpace::kRay, true));
  AcceleratorCounters counters;
  scene.occluded({{0, 0, 0}, {1, 0, 0}}, &counters);
  const Explanation explanation = scene.explain(counters, 100);
  ASSERT_EQ(explanation.areas.size(), 1u);
  const AreaReport& area = explanation.areas[0];
  EXPECT_EQ(area.name, "sun");
  EXPECT_EQ(area.triangles, mesh.triangle_count());
  EXPECT_GT(area.build_seconds, 0);
  EXPECT_GT(area.memory_bytes, 0u);
  EXPECT_EQ(area.times.size(), 4u);
  EXPECT_NE(area.structures.find("tree in ray space (shear_"), std::string::npos) << area.structures;
  const std::string text = to_text(explanation);
  EXPECT_NE(text.find("sun: coverage, tree in ray space"), std::string::npos) << text;
  EXPECT_NE(text.find("any hit: along it coverage, near it its tree"), std::string::npos) << text;
  EXPECT_NE(text.find("of 1 rays: 0.0 % answered by coverage"), std::string::npos) << text;
  EXPECT_TRUE(Accelerator(mesh).explain().areas.empty());
  EXPECT_THROW(scene.explain({}, 0), Error);
}

}  // namespace
}  // namespace raygrain

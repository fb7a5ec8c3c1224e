// What accelerators say of themselves: whom they ask for it, when areas pay, and what they hold.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/rays.h"
#include "raygrain/trace.h"

#include "accel/area_questions.h"
#include "accel/scenes.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

constexpr Vec3 kLight{0.5f, -0.7f, 0.5f}, kEye{9, 3, 0};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<InfluenceArea> areas_of(const TriangleMesh& mesh) {
  const Bounds box = mesh_bounds(mesh);
  return {directional_light_area("sun", kLight, box), camera_area("camera", kEye, center(box), 40, 1, box)};
}

Accelerator make_scene(LocalSpace space, bool covered) {
  const TriangleMesh mesh = mesh_families(2).front().mesh;
  AcceleratorOptions options;
  options.space = space;
  options.routing = Routing::kAreas;
  if (!covered) options.coverage.reset();
  return Accelerator(mesh, areas_of(mesh), options);
}

size_t count_covered(const Coverage& coverage, bool any, std::span<const Ray> rays) {
  return static_cast<size_t>(std::ranges::count_if(rays, [&](const Ray& ray) {
    return any ? coverage.occluded(ray).has_value() : coverage.intersect(ray).has_value();
  }));
}

TEST(Explain, TellsAfterHowManyRaysABuildHasPaid) {
  EXPECT_EQ(break_even_rays(0.5, 20, 120), 5e6);
  EXPECT_EQ(break_even_rays(3e-9, 1, 3), 1.5);
  EXPECT_EQ(break_even_rays(0, 20, 120), 0);
  EXPECT_EQ(break_even_rays(0.5, 120, 120), kInfinity);
  EXPECT_EQ(break_even_rays(0.5, 121, 120), kInfinity);
  EXPECT_EQ(break_even_rays(0.5, std::nan(""), 120), kInfinity);
  EXPECT_EQ(break_even_rays(std::nan(""), 20, 120), kInfinity);
}

TEST(Explain, AsksWhatUsersOfAnAreaAsk) {
  const Accelerator scene = make_scene(LocalSpace::kNone, true);
  const TriangleMesh& mesh = scene.mesh();
  const AreaGeometry sun(areas_of(mesh)[0]), camera(areas_of(mesh)[1]);
  for (const AreaGeometry* area : {&sun, &camera})
    for (const bool any : {true, false}) {
      const AreaQuestions questions = questions_of(*area, mesh, any, 500, 7);
      ASSERT_EQ(questions.size(), 500u);
      const double sense = any ? -1 : 1;
      size_t surfaces = 0;  // behind origins; rays that only graze theirs may miss it
      for (size_t i = 0; i < questions.size(); ++i) {
        const Ray& ray = questions.rays[i];
        EXPECT_EQ(ray.tmin, 0);
        if (area->is_plane()) {
          EXPECT_EQ(ray.direction, to_float(area->frame().forward * sense));
          EXPECT_EQ(ray.direction, questions.common);
          EXPECT_EQ(ray.tmax, kInf);
        } else {
          EXPECT_EQ(questions.common, kEye);
          EXPECT_EQ(any ? ray.direction : ray.origin, any ? kEye - ray.origin : kEye);
          EXPECT_EQ(ray.tmax, any ? 1 : kInf);
        }
        EXPECT_EQ(questions.points[i], any || area->is_plane() ? ray.origin : ray.direction);
        if (!any) continue;
        EXPECT_TRUE(area->serves(ray));
        const Ray back{ray.origin, -ray.direction, 0, kInf};
        surfaces += occluded_reference(mesh, back) ? 1 : 0;
      }
      if (any) {
        EXPECT_GE(surfaces, 490u);
      }
      EXPECT_EQ(questions.points, questions_of(*area, mesh, any, 500, 7).points);
      EXPECT_NE(questions.points, questions_of(*area, mesh, any, 500, 8).points);
    }
}

TEST(Explain, ReportsEveryQuestionWithTheStructureThatAnswers) {
  constexpr AreaQuestion kQuestions[] = {{true, true}, {false, true}, {true, false}, {false, false}};
  struct Case {
    LocalSpace space;
    bool covered;
  };
  for (const auto& [space, covered] : {Case{LocalSpace::kNone, true}, Case{LocalSpace::kRay, false}}) {
    const Accelerator scene = make_scene(space, covered);
    const Explanation explanation = scene.explain({}, 300);
    ASSERT_EQ(explanation.areas.size(), 2u);
    for (size_t a = 0; a < 2; ++a) {
      const AreaReport& area = explanation.areas[a];
      const AreaGeometry geometry(areas_of(scene.mesh())[a]);
      SCOPED_TRACE(area.name + ": " + area.structures);
      EXPECT_EQ(area.structures.find("coverage") != std::string::npos, covered);
      EXPECT_GT(area.build_seconds, 0);
      ASSERT_EQ(area.times.size(), 4u);
      for (size_t i = 0; i < 4; ++i) {
        const AreaTimes& t = area.times[i];
        SCOPED_TRACE(name(t.question));
        const AreaQuestions asked = questions_of(geometry, scene.mesh(), t.question.any, 300, a);
        EXPECT_EQ(t.question, kQuestions[i]);
        EXPECT_EQ(t.rays, 300u);
        EXPECT_GT(t.global_nanoseconds, 0);
        EXPECT_GT(t.area_nanoseconds, 0);
        if (t.use.answered() > 0) {
          EXPECT_EQ(t.break_even_rays, break_even_rays(area.build_seconds, t.area_nanoseconds, t.global_nanoseconds));
        }
        if (covered) {
          const uint64_t answered = count_covered(scene.coverages()[a], t.question.any, asked.rays);
          EXPECT_GT(answered, 285u);
          EXPECT_GT(area.build_seconds, scene.coverages()[a].build_seconds());  // choosing routes takes its time, too
          EXPECT_EQ(t.use, (AreaUse{answered, 0, 300 - answered}));
        } else if (area.name == "camera" && !t.question.any) {  // a local tree has no rays from before the near plane
          EXPECT_EQ(t.use, (AreaUse{0, 0, 300}));
          EXPECT_EQ(t.break_even_rays, kInfinity);
        } else {
          EXPECT_GT(t.use.local, 0u);
          EXPECT_EQ(t.use.local + t.use.global, 300u);
        }
      }
    }
  }
  const TriangleMesh mesh = mesh_families(2).front().mesh;
  AcceleratorOptions bare;
  bare.space = LocalSpace::kNone;
  bare.coverage.reset();
  const Accelerator scene(mesh, {directional_light_area("sun", kLight, mesh_bounds(mesh))}, bare);
  EXPECT_TRUE(scene.explain({}, 10).areas[0].times.empty());
}

TEST(Explain, SharesTheCountedRaysAmongAreas) {
  const Accelerator scene = make_scene(LocalSpace::kNone, true);
  std::vector<Ray> rays;
  const std::vector<Ray> sun = cast_rays(AreaRays{areas_of(scene.mesh())[0]}, 300, 5);
  for (size_t i = 0; i < 400; ++i) rays.push_back(i < 300 ? sun[i] : Ray{{0, 0, 0}, {0.7f, 0.7f, 0.1f}});
  std::vector<Hit> hits(rays.size());
  AcceleratorCounters counters;
  scene.intersect(rays, hits, 1, &counters);
  const Explanation explanation = scene.explain(counters, 10);
  const uint64_t covered = count_covered(scene.coverages()[0], false, sun);
  EXPECT_GT(covered, 285u);
  EXPECT_EQ(explanation.areas[0].use, (AreaUse{covered, 0, 300 - covered}));
  EXPECT_EQ(explanation.areas[0].share, static_cast<double>(covered) / 400);
  EXPECT_EQ(explanation.areas[1].share, 0);
  EXPECT_EQ(explanation.counters, counters);
  EXPECT_EQ(scene.explain({}, 10).areas[0].share, 0);
  counters.areas.resize(3);
  EXPECT_EQ(error_of([&] { scene.explain(counters, 10); }).code, ErrorCode::kUsage);
}

/// Squares of side 1 at z = 0.
TriangleMesh floor_of(int side) {
  TriangleMesh mesh;
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      const auto x = static_cast<float>(i), y = static_cast<float>(k);
      const auto first = static_cast<uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), {{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  return mesh;
}

// Nothing says that a structure pays for rays that there are none of.
TEST(Explain, SaysWhereNoAnyHitsWereFound) {
  const TriangleMesh mesh = floor_of(40);
  // One ends in the floor, and rays from there start outside; the other has a thousandth of it.
  const InfluenceArea sun = directional_light_area("sun", {0, 0, -1}, mesh_bounds(mesh));
  const InfluenceArea spot{"spot", PlaneArea{{20.5f, 20.5f, 5}, {0, 0, -1}, {0, 1, 0}, 0.4f, 0.4f, 10}};
  for (const LocalSpace space : {LocalSpace::kNone, LocalSpace::kRay}) {
    AcceleratorOptions options;
    options.space = space;
    const Accelerator scene(mesh, {sun, spot}, options);
    const Explanation explanation = scene.explain({}, 2000);
    const std::string none = "any hit: along it global tree, near it global tree (no rays along it to sample)\n";
    EXPECT_EQ(explanation.areas[0].routes.find(none), 0u) << explanation.areas[0].routes;
    EXPECT_EQ(explanation.areas[1].routes.find("any hit: along it coverage"), 0u) << explanation.areas[1].routes;
    EXPECT_EQ(explanation.areas[0].times.size(), 2u);
    EXPECT_EQ(explanation.areas[1].times.size(), 4u);
    EXPECT_EQ(missing_times(explanation.areas[0]).find("no any-hit rays found: "), 0u);
    EXPECT_EQ(missing_times(explanation.areas[1]), "");
    EXPECT_EQ(missing_times({}), "");  // not asked
    const std::string text = to_text(explanation), line = "\n  no any-hit rays found: ";
    EXPECT_LT(text.find(line), text.find("\nspot: "));
    EXPECT_EQ(text.find(line), text.rfind(line));
    AcceleratorCounters counters;
    EXPECT_FALSE(scene.occluded({{3.5f, 3.2f, 1}, {0, 0, 1}}, &counters));
    EXPECT_EQ(counters.covered, 0u);
    EXPECT_TRUE(scene.occluded({{3.5f, 3.2f, -1}, {0, 0, 1}}, &counters));
    EXPECT_EQ(counters.global_searches, 2u);
  }
}

TEST(Explain, LeadsWithWhatPaysSoonest) {
  AreaReport sun{"sun", 12, 0.25, 3'500'000, "coverage", "any hit: a\nclosest hit: b\n", {}, {20, 5, 10}, 0.25};
  sun.times = {{{true, true}, 100, {99, 0, 1}, 20, 120, 2.5e6},
               {{false, true}, 100, {100, 0, 0}, 121, 120, kInfinity},
               {{true, false}, 100, {0, 100, 0}, 100, 350, 1e6},
               {{false, false}, 100, {}, 90, 90, kInfinity}};
  Explanation explanation;
  explanation.areas = {sun, {"moon", 0, 0, 0, "", "any hit: c\n", {}, {}, 0}};
  explanation.global_bytes = 7'000'000;
  explanation.shared_bytes = 100'000;
  explanation.counters.rays = 100;
  explanation.counters.covered = 20;
  explanation.counters.global_searches = 70;
  explanation.counters.invalid_rays = 1;
  explanation.counters.local_searches = 17;
  EXPECT_EQ(
      to_text(explanation),
      "sun: coverage\n"
      "  pays after about 1,000,000 rays: any hits one by one (100 ns a ray, 350 ns through the global tree; "
      "0 % answered by coverage, 100 % by its tree)\n"
      "  pays after about 2,500,000 rays: any hits together (20 ns a ray, 120 ns through the global tree; "
      "99 % answered by coverage, 0 % by its tree)\n"
      "  saves nothing: closest hits together (121 ns a ray, 120 ns through the global tree; "
      "100 % answered by coverage, 0 % by its tree)\n"
      "  left to the global tree: closest hits one by one (90 ns a ray, 90 ns without areas)\n"
      "  built in 0.250 s (timed once), 3.3 MiB, 12 triangles in its tree\n"
      "  any hit: a\n"
      "  closest hit: b\n"
      "  of the counted rays: 20 % answered by coverage, 5 % by its tree; 10 % were its own and went to the global "
      "tree\n"
      "moon: no structures\n"
      "  built in 0.000 s (timed once), 0 B\n"
      "  any hit: c\n"
      "  of the counted rays: 0 % answered by coverage, 0 % by its tree; 0 % were its own and went to the global "
      "tree\n"
      "global tree: 6.7 MiB; shared by the areas: 97.7 KiB\n"
      "of 100 rays: 20.0 % answered by coverage, 9.0 % by local trees, 70.0 % needed the global tree, 1.0 % "
      "invalid\n"
      "local searches in ray space: 0 as columns, 0 as cones, of 17\n");
}

size_t sum_of(const Explanation& explanation) {
  size_t bytes = explanation.global_bytes + explanation.shared_bytes;
  for (const AreaReport& area : explanation.areas) bytes += area.memory_bytes;
  return bytes;
}

TEST(AcceleratorMemory, IsTheSumOfItsPartsEachOnce) {
  const Accelerator world = make_scene(LocalSpace::kWorld, false), in_ray_space = make_scene(LocalSpace::kRay, false);
  const size_t corners = 36 * world.mesh().triangle_count();
  size_t trees = 0;
  for (const LocalTree& local : in_ray_space.local_trees()) {
    ASSERT_TRUE(local.in_ray_space);
    EXPECT_EQ(local.in_ray_space->corners()->memory_bytes(), corners);
    trees += local.in_ray_space->memory_bytes();
  }
  EXPECT_EQ(in_ray_space.wide_memory_bytes(), world.wide_memory_bytes() + trees + corners);
  EXPECT_EQ(in_ray_space.memory_bytes(), world.memory_bytes() + trees + corners);
  EXPECT_EQ(in_ray_space.explain({}, 1).shared_bytes, world.explain({}, 1).shared_bytes + corners);
  const Accelerator covered = make_scene(LocalSpace::kRay, true);
  size_t coverages = 0;
  for (const Coverage& coverage : covered.coverages()) coverages += coverage.memory_bytes();
  EXPECT_GT(coverages, 0u);
  EXPECT_GE(covered.memory_bytes(), in_ray_space.memory_bytes() + coverages);
  EXPECT_LT(covered.memory_bytes(), in_ray_space.memory_bytes() + coverages + 500);  // tables
  for (const Accelerator* scene : {&world, &in_ray_space, &covered}) {
    const Explanation explanation = scene->explain({}, 1);
    EXPECT_EQ(sum_of(explanation), scene->memory_bytes());
    EXPECT_GT(explanation.areas[0].memory_bytes, memory_bytes(*scene->local_trees()[0].tree));
  }
}

/// Finished parts that are handed in twice.
TEST(AcceleratorMemory, CountsWhatAreasShareOnce) {
  const Accelerator scene = make_scene(LocalSpace::kRay, false);
  const LocalTree local = scene.local_trees()[0];
  const Accelerator once = scene.with_local_trees({local}), twice = scene.with_local_trees({local, local});
  const Explanation first = once.explain({}, 1), second = twice.explain({}, 1);
  const size_t shared = memory_bytes(*local.tree) + local.in_ray_space->memory_bytes();
  EXPECT_EQ(second.areas[0].memory_bytes, first.areas[0].memory_bytes);
  EXPECT_EQ(second.areas[1].memory_bytes, first.areas[0].memory_bytes - shared);
  EXPECT_EQ(sum_of(second), twice.memory_bytes());
}

}  // namespace
}  // namespace raygrain::test

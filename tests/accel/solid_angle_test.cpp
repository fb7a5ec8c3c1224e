// Trees made for isotropic light beside those made for rays that are uniform on the near plane.
// AnswerAlikeAndWhatTheyAreWorth prints the figures of docs/performance-rays.md with RAYGRAIN_TEST_SCALE=full, times
// included.
#include <algorithm>
#include <array>
#include <ctime>
#include <functional>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/io.h"
#include "raygrain/rays.h"
#include "raygrain/scene.h"

#include "accel/build_trees.h"
#include "accel/scenes.h"
#include "base/timer.h"
#include "support/isotropic_rays.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"
#include "support/shared.h"

namespace raygrain {
namespace {

using RaysOfFrusta = std::vector<std::vector<Ray>>;

/// Trees of a lamp's six frusta, made for one density.
struct LampTrees {
  std::vector<FrameTree> frames;
  std::vector<WideBvh> world;
  double frame_seconds = 0, world_seconds = 0;

  LampTrees(const TriangleMesh& mesh, const std::vector<InfluenceArea>& areas, RayDensity density) {
    const Registry registry = default_registry();
    const auto corners = std::make_shared<const TriangleCorners>(mesh);
    AcceleratorOptions options;
    options.density = density;
    options.threads = 1;
    const Recipe recipe{density == RayDensity::kSolidAngle ? "SOLID" : "PAH", "ALL", "spatial", {}, true};
    for (const InfluenceArea& area : areas) {
      const std::vector<uint32_t> members = area_members(mesh, AreaGeometry(area));
      const Timer timer;
      frames.push_back(*build_area_frame_tree(area, corners, members, {}, options));
      const double seconds = timer.seconds();
      const LocalTree local = build_local_tree(mesh, area, recipe, registry, {}, {}, {1, {}, true});
      world.push_back({*local.tree, mesh, {.measure = local.measure, .threads = 1}});
      frame_seconds += seconds;
      world_seconds += timer.seconds() - seconds;
    }
  }
};

using Ask = std::function<void(const LampTrees&, size_t frustum, const Ray&, TraceCounters*)>;

/// What a lamp's rays, frustum by frustum, ask of one form of the trees.
struct Question {
  const char* name;
  const RaysOfFrusta& rays;
  Ask ask;
};

template <class Tree>
void nearest(const Tree& tree, const Ray& ray, TraceCounters* counters) {
  if (counters != nullptr) {
    tree.intersect_counted(ray, *counters);
  } else {
    tree.intersect(ray);
  }
}

template <class Tree>
void any(const Tree& tree, const Ray& ray, TraceCounters* counters) {
  if (counters != nullptr) {
    tree.occluded_counted(ray, *counters);
  } else {
    tree.occluded(ray);
  }
}

std::vector<Question> questions(const RaysOfFrusta& from, const RaysOfFrusta& to) {
  using Trees = const LampTrees&;
  using Counters = TraceCounters*;
  return {{"ray space, closest", from, [](Trees t, size_t i, const Ray& r, Counters c) { nearest(t.frames[i], r, c); }},
          {"ray space, any", to, [](Trees t, size_t i, const Ray& r, Counters c) { any(t.frames[i], r, c); }},
          {"world, closest", from, [](Trees t, size_t i, const Ray& r, Counters c) { nearest(t.world[i], r, c); }},
          {"world, any", to, [](Trees t, size_t i, const Ray& r, Counters c) { any(t.world[i], r, c); }}};
}

void ask_all(const Question& question, const LampTrees& trees, TraceCounters* counters) {
  for (size_t i = 0; i < question.rays.size(); ++i)
    for (const Ray& ray : question.rays[i]) question.ask(trees, i, ray, counters);
}

double cost_of(const Question& question, const LampTrees& trees) {
  TraceCounters counters;
  ask_all(question, trees, &counters);
  return 2 * static_cast<double>(counters.inner_hits) + 1.2 * static_cast<double>(counters.leaf_triangles);
}

/// Of this process alone, in which one thread runs.
double seconds_of(const Question& question, const LampTrees& trees) {
  const std::clock_t begin = std::clock();
  ask_all(question, trees, nullptr);
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// The middle one of many pairs of passes, taken in turns.
double time_ratio(const Question& question, const LampTrees& trees, const LampTrees& base) {
  std::array<double, 61> ratios;
  for (double& ratio : ratios) {
    const double seconds = seconds_of(question, trees);
    ratio = seconds / seconds_of(question, base);
  }
  std::ranges::nth_element(ratios, ratios.begin() + ratios.size() / 2);
  return ratios[ratios.size() / 2];
}

std::vector<Scene> scenes() {
  const bool full = test::is_full_scale();
  std::vector<Scene> scenes;
  for (const ProceduralOptions& options :
       {ProceduralOptions{"city", full ? 15u : 3u}, {"forest", full ? 16u : 3u}, {"terrain", full ? 224u : 30u}}) {
    scenes.push_back(generate_scene(options));
    scenes.back().name = options.kind;
  }
  if (test::seed_count(4) == 1) scenes.erase(scenes.begin(), scenes.begin() + 2);  // small: the smallest alone
  if (const auto crowd = test::shared_scene("crowd.ply"); crowd && full) {
    scenes.emplace_back();
    scenes.back().name = "crowd";
    scenes.back().mesh = load_mesh(*crowd);
  }
  return scenes;
}

/// Of a lamp above the scene's middle: its height is a share of the scene's.
Vec3 lamp_in(const Bounds& box, float height) {
  return {center(box).x + 0.01f, box.lo.y + height * (box.hi.y - box.lo.y), center(box).z + 0.013f};
}

RaysOfFrusta rays_from(const std::vector<InfluenceArea>& areas, size_t count) {
  RaysOfFrusta rays;
  for (const InfluenceArea& area : areas) rays.push_back(test::isotropic_rays(area, count / areas.size(), 7));
  return rays;
}

/// From points of surfaces, evenly by their area.
RaysOfFrusta rays_to(const std::vector<InfluenceArea>& areas, const TriangleMesh& mesh, Vec3 lamp, size_t count) {
  std::vector<AreaGeometry> geometries(areas.begin(), areas.end());
  RaysOfFrusta rays(areas.size());
  for (const Ray& ray : cast_rays(SurfaceRays{TowardsPoint{lamp}}, mesh, count, 5)) {
    const auto serving = std::ranges::find_if(geometries, [&](const AreaGeometry& g) { return g.serves(ray); });
    if (serving != geometries.end()) rays[static_cast<size_t>(serving - geometries.begin())].push_back(ray);
  }
  return rays;
}

/// Rays whose answers differ in any bit.
size_t differences(const LampTrees& a, const LampTrees& b, const RaysOfFrusta& from, const RaysOfFrusta& to) {
  size_t count = 0;
  for (size_t i = 0; i < from.size(); ++i)
    for (const Ray& ray : from[i]) {
      const auto x = a.frames[i].intersect(ray), y = b.frames[i].intersect(ray);
      count += !x || !y || !test::same_bits(*x, *y) || !test::same_bits(*x, a.world[i].intersect(ray));
      count += !test::same_bits(a.world[i].intersect(ray), b.world[i].intersect(ray));
    }
  for (size_t i = 0; i < to.size(); ++i)
    for (const Ray& ray : to[i]) {
      const auto x = a.frames[i].occluded(ray), y = b.frames[i].occluded(ray);
      count += !x || !y || *x != *y || a.world[i].occluded(ray) != b.world[i].occluded(ray);
    }
  return count;
}

TEST(SolidAngleTrees, AnswerAlikeAndWhatTheyAreWorth) {
  for (const Scene& scene : scenes())
    for (const float height : {0.6f, 1.2f}) {
      if (height > 1 && !test::is_full_scale()) continue;
      const Bounds box = mesh_bounds(scene.mesh);
      const Vec3 lamp = lamp_in(box, height);
      const std::vector<InfluenceArea> areas = point_light_areas("lamp", lamp, box);
      const LampTrees plane(scene.mesh, areas, RayDensity::kNearPlane),
          solid(scene.mesh, areas, RayDensity::kSolidAngle);
      const size_t count = test::is_full_scale() ? 20000 : 600;
      const RaysOfFrusta from = rays_from(areas, count), to = rays_to(areas, scene.mesh, lamp, count);
      EXPECT_EQ(differences(solid, plane, from, to), 0u);
      std::cout << scene.name << ", " << scene.mesh.triangle_count() << " triangles, lamp at " << height << ": build "
                << solid.frame_seconds / plane.frame_seconds << ' ' << solid.world_seconds / plane.world_seconds;
      for (const Question& question : questions(from, to)) {
        const double ratio = cost_of(question, solid) / cost_of(question, plane);
        EXPECT_NE(ratio, 1);
        EXPECT_GT(ratio, 0.7);
        EXPECT_LT(ratio, 1.4);
        std::cout << "; " << question.name << ": cost " << ratio;
        if (test::is_full_scale()) std::cout << ", time " << time_ratio(question, solid, plane);
      }
      std::cout << std::endl;
    }
}

FrameTree tree_of(const TriangleMesh& mesh, const InfluenceArea& area, RayDensity density) {
  AcceleratorOptions options;
  options.density = density;
  return test::tree_in_ray_space(mesh, area, options);
}

bool are_alike(const FrameTree& a, const FrameTree& b, std::span<const Ray> rays) {
  TraceCounters x, y;
  for (const Ray& ray : rays) a.intersect_counted(ray, x), b.intersect_counted(ray, y);
  return x == y && a.node_count() == b.node_count() && a.leaf_count() == b.leaf_count();
}

// The accelerator hands the density on for point areas; plane areas have none.
TEST(SolidAngleTrees, AreMadeByTheAccelerator) {
  const TriangleMesh mesh = generate_scene({"terrain", 25}).mesh;
  const Bounds box = mesh_bounds(mesh);
  const InfluenceArea lamp = point_light_areas("lamp", lamp_in(box, 1.2f), box)[3],
                      sun = directional_light_area("sun", {0.3f, -0.8f, 0.5f}, box);
  const AreaGeometry geometry(lamp);
  const RayFrame frame = *area_frame(FrameKind::kProjective, geometry);
  const FrameTree expected =
      *build_frame_tree(frame, std::make_shared<const TriangleCorners>(mesh), area_members(mesh, geometry),
                        {.weights = frame_area_weights(frame, geometry), .density = RayDensity::kSolidAngle});
  const std::vector<Ray> rays = test::isotropic_rays(lamp, 300, 1), parallel = cast_rays(AreaRays{sun}, 300, 1);
  EXPECT_TRUE(are_alike(tree_of(mesh, lamp, RayDensity::kSolidAngle), expected, rays));
  EXPECT_FALSE(are_alike(tree_of(mesh, lamp, RayDensity::kNearPlane), expected, rays));
  EXPECT_TRUE(
      are_alike(tree_of(mesh, sun, RayDensity::kNearPlane), tree_of(mesh, sun, RayDensity::kSolidAngle), parallel));
}

}  // namespace
}  // namespace raygrain

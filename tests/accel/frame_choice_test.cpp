// Trees in ray space for areas: what their tolerance changes, and whether the frame that a subset of the triangles
// chooses is the best for all of them.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/families.h"
#include "raygrain/rays.h"
#include "raygrain/scene.h"

#include "accel/build_trees.h"
#include "accel/scenes.h"
#include "support/mesh_families.h"

namespace raygrain {
namespace {

constexpr Vec3 kSuns[] = {{-0.42f, -0.85f, 0.31f}, {0.8f, -0.35f, 0.5f}, {0.6f, -0.5f, 0.6f}};
const auto kFiveDegrees = static_cast<float>(1 - std::cos(5 * 3.14159265358979 / 180));

std::vector<uint32_t> all_triangles(const TriangleMesh& mesh) {
  std::vector<uint32_t> ids(mesh.triangle_count());
  std::iota(ids.begin(), ids.end(), 0u);
  return ids;
}

struct FrameCosts {
  double least = kInf, greatest = 0, chosen = kInf;
  FrameKind best = FrameKind::kRotation, choice = FrameKind::kRotation;
};

/// Predicted for the whole trees, in all frames of an area and in the chosen one.
FrameCosts costs_of(const TriangleMesh& mesh, const InfluenceArea& area) {
  const AreaGeometry geometry(area);
  const auto corners = std::make_shared<const TriangleCorners>(mesh);
  const std::vector<uint32_t> ids = all_triangles(mesh);
  FrameCosts costs;
  costs.choice = build_area_frame_tree(area, corners, ids, {}, {})->frame().kind;
  for (const FrameKind kind : frame_kinds(geometry)) {
    const RayFrame frame = *area_frame(kind, geometry);
    double cost = kInf;
    build_frame_tree(frame, corners, ids, {.weights = frame_area_weights(frame, geometry)}, &cost);
    if (cost < costs.least) costs.best = kind;
    costs.least = std::min(costs.least, cost);
    costs.greatest = std::max(costs.greatest, cost);
    if (kind == costs.choice) costs.chosen = cost;
  }
  return costs;
}

// A quarter of the triangles decide; at full scale, with ten times as many, an eighth.
TEST(FrameChoice, OnASubsetIsNearlyTheBest) {
  double worst = 1, farthest = 1;
  std::set<FrameKind> chosen;
  const uint64_t scale = test::seed_count(10);  // 2, 10 or 100
  const auto size = [&](double usual) {
    return static_cast<uint32_t>(usual * std::sqrt(static_cast<double>(scale) / 10));
  };
  for (const ProceduralOptions& options :
       {ProceduralOptions{"city", size(8)}, {"forest", size(8)}, {"terrain", size(120)}}) {
    const TriangleMesh mesh = generate_scene(options).mesh;
    for (const Vec3 sun : {kSuns[1], kSuns[2]}) {
      const FrameCosts costs = costs_of(mesh, directional_light_area("sun", sun, mesh_bounds(mesh)));
      std::cout << options.kind << ", " << mesh.triangle_count() << " triangles: " << name(costs.choice) << ", best "
                << name(costs.best) << ", " << costs.chosen / costs.least << " of its cost, the worst "
                << costs.greatest / costs.least << '\n';
      worst = std::max(worst, costs.chosen / costs.least);
      farthest = std::max(farthest, costs.greatest / costs.least);
      chosen.insert(costs.choice);
    }
  }
  std::cout << "chosen frames cost at most " << worst << " of the best, others up to " << farthest << '\n';
  EXPECT_LE(worst, 1.03);
  EXPECT_GE(farthest, 1.3);
  EXPECT_GE(chosen.size(), 2u);
}

// All triangles decide: the choice is the best.
TEST(FrameChoice, OnSmallMeshesIsTheBest) {
  size_t differing = 0;
  for (const test::NamedMesh& family : test::mesh_families(12)) {
    const Bounds box = mesh_bounds(family.mesh);
    if (is_empty(box) || !(length(extent(box)) < 1e9f && length(extent(box)) > 1e-6f)) continue;
    SCOPED_TRACE(family.name);
    for (const Vec3 sun : kSuns) {
      const FrameCosts costs = costs_of(family.mesh, directional_light_area("sun", sun, box));
      ASSERT_EQ(costs.choice, costs.best);
      differing += costs.greatest > 1.05 * costs.least;
    }
  }
  EXPECT_GT(differing, 10u);
}

TraceCounters counted(const FrameTree& tree, const std::vector<Ray>& rays) {
  TraceCounters counters;
  for (const Ray& ray : rays) tree.intersect_counted(ray, counters);
  return counters;
}

bool are_alike(const FrameTree& a, const FrameTree& b, const std::vector<Ray>& rays) {
  const TraceCounters x = counted(a, rays), y = counted(b, rays);
  return a.node_count() == b.node_count() && a.leaf_count() == b.leaf_count() && x.inner_hits == y.inner_hits &&
         x.leaf_hits == y.leaf_hits && x.leaf_triangles == y.leaf_triangles;
}

FrameTree tree_of(const TriangleMesh& mesh, InfluenceArea area, float tolerance, FrameKind kind) {
  area.tolerance = tolerance;
  AcceleratorOptions options;
  options.frame = kind;
  return test::tree_in_ray_space(mesh, area, options);
}

// Without a tolerance the tree for columns, bit for bit; with 5 degrees another.
TEST(FrameChoice, TheToleranceMakesTheTree) {
  const TriangleMesh mesh = test::random_mesh(3000, 4);
  const Bounds box = mesh_bounds(mesh);
  const InfluenceArea sun = directional_light_area("sun", kSuns[0], box);
  const InfluenceArea lamp{"lamp", PointArea{{0.5f, 6, 0.25f}, {0, -1, 0}, {0, 0, 1}, 70, 70, 1, 10}};
  const auto corners = std::make_shared<const TriangleCorners>(mesh);
  for (const auto& [area, kind] : {std::pair{sun, FrameKind::kRotation}, std::pair{sun, FrameKind::kShearY},
                                   std::pair{lamp, FrameKind::kProjective}}) {
    SCOPED_TRACE(name(kind));
    const AreaGeometry geometry(area);
    const RayFrame frame = *area_frame(kind, geometry);
    const std::vector<Ray> rays = cast_rays(AreaRays{area}, 500, 1);
    const Vec3d column = geometry.is_plane()
                             ? frame_face_weights(frame, std::vector{to_float(geometry.frame().forward)})
                             : Vec3d{0, 0, 1};
    const FrameTree columns = *build_frame_tree(frame, corners, area_members(mesh, geometry), {.weights = column});
    EXPECT_TRUE(are_alike(tree_of(mesh, area, 0, kind), columns, rays));
    EXPECT_TRUE(are_alike(tree_of(mesh, area, kFiveDegrees, kind), tree_of(mesh, area, kFiveDegrees, kind), rays));
    EXPECT_FALSE(are_alike(tree_of(mesh, area, kFiveDegrees, kind), columns, rays));
  }
}

double pruned_cost(const TraceCounters& c) {
  return 2 * static_cast<double>(c.inner_hits) + 1.2 * static_cast<double>(c.leaf_triangles);
}

// Rays of a cone in the tree for its tolerance, beside the tree for columns: the z term has done most of it already.
TEST(FrameChoice, TheToleranceCostsItsRaysNothing) {
  for (const ProceduralOptions& options : {ProceduralOptions{"city", 5}, {"forest", 5}, {"terrain", 70}}) {
    const TriangleMesh mesh = generate_scene(options).mesh;
    const auto corners = std::make_shared<const TriangleCorners>(mesh);
    InfluenceArea sun = directional_light_area("sun", kSuns[0], mesh_bounds(mesh));
    sun.tolerance = kFiveDegrees;
    const AreaGeometry geometry(sun);
    AreaRays cone{sun};
    cone.cone_degrees = 5;
    const std::vector<Ray> rays = cast_rays(cone, 2000, 3);
    for (const FrameKind kind : {FrameKind::kRotation, FrameKind::kShearX, FrameKind::kShearY}) {
      const RayFrame frame = *area_frame(kind, geometry);
      const auto cost = [&](Vec3d weights) {
        return pruned_cost(counted(*build_frame_tree(frame, corners, all_triangles(mesh), {.weights = weights}), rays));
      };
      const double ratio = cost(frame_area_weights(frame, geometry)) / cost({0, 0, 1});
      std::cout << options.kind << ", " << name(kind) << ": " << ratio << " of the cost\n";
      EXPECT_LT(ratio, 1.1);
      EXPECT_NE(ratio, 1);
    }
  }
}

}  // namespace
}  // namespace raygrain

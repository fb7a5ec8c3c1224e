// Small hand-made scenes for tests of the accelerator.
#pragma once

#include <string>
#include <vector>

#include "raygrain/accelerator.h"

#include "base/random.h"
#include "support/error_of.h"

namespace raygrain::test {

inline void add_triangle(TriangleMesh& mesh, Vec3 a, Vec3 b, Vec3 c) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// A triangle in the plane z = `z` that holds the circle of `radius` around the z axis.
inline void add_floor(TriangleMesh& mesh, float z, float radius) {
  add_triangle(mesh, {-4 * radius, -2 * radius, z}, {4 * radius, -2 * radius, z}, {0, 4 * radius, z});
}

/// The area's tree in ray space, in an accelerator whose areas have nothing else.
inline FrameTree tree_in_ray_space(const TriangleMesh& mesh, const InfluenceArea& area, AcceleratorOptions options) {
  options.space = LocalSpace::kRay;
  options.routing = Routing::kAreas;
  options.coverage.reset();
  return *Accelerator(mesh, {area}, options).local_trees()[0].in_ray_space;
}

/// The box |x|, |y| <= half, z_begin <= z <= z_begin + depth, with rays along +z.
inline InfluenceArea z_area(const std::string& name, float z_begin, float depth, float half = 1,
                            float tolerance = 0.01f) {
  return {name, PlaneArea{{0, 0, z_begin}, {0, 0, 1}, {0, 1, 0}, half, half, depth}, tolerance};
}

/// An accelerator from local trees with predicted costs of the test's choice, one per area.
inline Accelerator with_costs(const TriangleMesh& mesh, const std::vector<InfluenceArea>& areas,
                              const std::vector<double>& costs, const TopLevelOptions& top_level = {}) {
  const Registry registry = default_registry();
  std::vector<LocalTree> locals;
  for (size_t i = 0; i < areas.size(); ++i) {
    locals.push_back(build_local_tree(mesh, areas[i], {"PAH", "ALL", "binned", {}}, registry));
    locals.back().predicted_cost = costs[i];
  }
  auto global = std::make_shared<const Bvh>(build_global_tree(mesh, {"SAH", "ALL", "binned", {}}, registry));
  return Accelerator(std::make_shared<const TriangleMesh>(mesh), std::move(locals), std::move(global), top_level);
}

/// Points on the faces, edges and corners of a region, rounded to float.
inline std::vector<Vec3> border_points(const ConvexRegion& region) {
  std::vector<Vec3> points;
  for (int code = 0; code < 27; ++code) {
    const double weights[] = {code % 3 * 0.5, code / 3 % 3 * 0.5, code / 9 * 0.5};
    Vec3d point{};
    for (size_t i = 0; i < 8; ++i) {
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) weight *= ((i >> axis) & 1) ? weights[axis] : 1 - weights[axis];
      point = point + region.corners[i] * weight;
    }
    points.push_back(to_float(point));
  }
  return points;
}

inline TriangleMesh random_mesh(size_t count, uint64_t seed) {
  Random random(seed);
  const auto vector = [&](double half_size) {
    const double x = random.uniform(-half_size, half_size), y = random.uniform(-half_size, half_size);
    return Vec3d{x, y, random.uniform(-half_size, half_size)};
  };
  TriangleMesh mesh;
  for (size_t i = 0; i < count; ++i) {
    const Vec3d a = vector(2);
    add_triangle(mesh, to_float(a), to_float(a + vector(0.5)), to_float(a + vector(0.5)));
  }
  return mesh;
}

inline std::vector<InfluenceArea> some_areas() {
  return {z_area("sun", -1, 2),
          {"lamp", PointArea{{0.5f, 3, 0.25f}, {0, -1, 0}, {0, 1, 0}, 90, 60, 0.2f, 6}},
          {"corner", PlaneArea{{2, 2, 2}, {-1, -1, -1}, {0, 0, 1}, 0.7f, 0.7f, 3}}};
}

}  // namespace raygrain::test

// Trees small enough to count by hand, and meshes of random triangles.
#pragma once

#include <vector>

#include "raygrain/area.h"
#include "raygrain/bvh.h"
#include "raygrain/mesh.h"

#include "base/random.h"

namespace raygrain::test {

inline Bvh::Node inner_node(const Bounds& bounds, uint32_t first_child) {
  return {bounds, first_child, 0};
}
inline Bvh::Node leaf_node(const Bounds& bounds, uint32_t first, uint32_t count) {
  return {bounds, first, count};
}

/// Root over a leaf of 2 and an inner node over leaves of 1 and 3. Widths along x: 8; 2, 5; 1, 4.
inline Bvh five_nodes() {
  Bvh bvh;
  bvh.nodes = {inner_node({{0, 0, 0}, {8, 1, 1}}, 1), leaf_node({{0, 0, 0}, {2, 1, 1}}, 0, 2),
               inner_node({{3, 0, 0}, {8, 1, 1}}, 3), leaf_node({{3, 0, 0}, {4, 1, 1}}, 2, 1),
               leaf_node({{4, 0, 0}, {8, 1, 1}}, 3, 3)};
  bvh.prims = {0, 1, 2, 3, 4, 5};
  return bvh;
}

/// Adds the triangle (x, y) - (x + 1, y) - (x, y + 1) at depth z.
inline void add_triangle(TriangleMesh& mesh, float x, float y, float z) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{x, y, z}, {x + 1, y, z}, {x, y + 1, z}});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Triangles of up to `size` with their first corners uniform in a box.
inline TriangleMesh random_triangles(const Bounds& box, size_t count, double size, uint64_t seed) {
  Random random(seed);
  const auto uniform = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
  TriangleMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 corner{uniform(box.lo.x, box.hi.x), uniform(box.lo.y, box.hi.y), uniform(box.lo.z, box.hi.z)};
    mesh.vertices.push_back(corner);
    for (int other = 0; other < 2; ++other) {
      mesh.vertices.push_back(corner + Vec3{uniform(-size, size), uniform(-size, size), uniform(-size, size)});
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// A sun that looks along `direction` at a box of +-10 around the origin, from 20 away.
inline InfluenceArea sun_over(Vec3 direction, float half_width, float half_height) {
  const Vec3d d = normalized(to_double(direction));
  return {"sun", PlaneArea{to_float(d * -20.0), direction, {0, 1, 0}, half_width, half_height, 40}};
}

/// A point light 20 away from the origin, looking at it along `direction`.
inline InfluenceArea lamp_over(Vec3 direction, float fov_x, float fov_y) {
  const Vec3d d = normalized(to_double(direction));
  return {"lamp", PointArea{to_float(d * -20.0), direction, {0, 1, 0}, fov_x, fov_y, 1, 40}};
}

}  // namespace raygrain::test

// Named families of meshes that every property test loops over, and rays aimed where tracers fail.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "raygrain/mesh.h"
#include "raygrain/ray.h"

namespace raygrain::test {

struct NamedMesh {
  std::string name;  // e.g. "closed_sphere"
  TriangleMesh mesh;
  bool closed = false;  // watertight: every edge shared by exactly two triangles
  Vec3 inside{};        // a point well inside, for closed meshes
};

/// closed, open, empty, one_triangle, sliver, degenerate, duplicate, huge, tiny, far, large_triangles, soup ...: at
/// most a few hundred triangles each, so that brute force stays cheap.
std::vector<NamedMesh> mesh_families(uint64_t seed);

/// A mix: random, aimed at edges, at vertices, axis-parallel, lying in faces' planes, grazing, starting on surfaces,
/// with finite [tmin, tmax], a few invalid (NaN, zero direction).
std::vector<Ray> aimed_rays(const TriangleMesh& mesh, size_t count, uint64_t seed);

/// How many seeds a property test takes: `usual`, a quarter of it where the environment says RAYGRAIN_TEST_SCALE=small
/// (instrumented builds), ten times as many for RAYGRAIN_TEST_SCALE=full. At least one.
uint64_t seed_count(uint64_t usual);

}  // namespace raygrain::test

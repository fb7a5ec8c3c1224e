// The scenes Random100 and Random1000 of "Ray Distribution Aware Heuristics for Bounding Volume Hierarchies
// Construction in Ray Tracing" (2024). std::mt19937 is specified bit by bit; the distribution is written out, because
// the standard's is not.
#include <random>

#include "io/procedural.h"

namespace raygrain {
namespace {

double draw_unit(std::mt19937& engine) {
  const double low = static_cast<double>(engine()), high = static_cast<double>(engine());
  return (low + high * 0x1p32) * 0x1p-64;
}

Vec3 draw_vector(std::mt19937& engine, double lo, double hi) {
  Vec3 v;
  for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<float>(draw_unit(engine) * (hi - lo) + lo);
  return v;
}

TriangleMesh draw_triangles(std::mt19937& engine, uint32_t count) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 a = draw_vector(engine, 0, 10);
    const Vec3 b = a + draw_vector(engine, -1, 1);
    const Vec3 c = b + draw_vector(engine, -1, 1);
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace

TriangleMesh make_random_100(uint32_t seed) {
  std::mt19937 engine(seed);
  return draw_triangles(engine, 100);
}

TriangleMesh make_random_1000(uint32_t seed) {
  std::mt19937 engine(seed);
  draw_triangles(engine, 100);
  return draw_triangles(engine, 1000);
}

}  // namespace raygrain

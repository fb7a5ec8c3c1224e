#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/trigonometry.h"
#include "families/shapes.h"

namespace raygrain::shapes {

using Triangle = std::array<uint32_t, 3>;

Vec3d random_point(Random& random, double half_size) {
  const double x = random.uniform(-half_size, half_size);
  const double y = random.uniform(-half_size, half_size);
  return {x, y, random.uniform(-half_size, half_size)};
}

Vec3d snapped(Vec3d p, double unit) {
  return {std::round(p.x / unit) * unit, std::round(p.y / unit) * unit, std::round(p.z / unit) * unit};
}

Vec3 clamped_to_float(Vec3d p) {
  constexpr double kMax = std::numeric_limits<float>::max();
  return to_float({std::clamp(p.x, -kMax, kMax), std::clamp(p.y, -kMax, kMax), std::clamp(p.z, -kMax, kMax)});
}

NamedMesh closed_box(int n) {
  NamedMesh box{"closed_box", {}, true, {}};
  std::map<std::array<int, 3>, uint32_t> index_of;
  const auto vertex = [&](int axis, int side, int i, int j) {
    std::array<int, 3> key{};
    key[static_cast<size_t>(axis)] = side * n;
    key[static_cast<size_t>((axis + 1) % 3)] = i;
    key[static_cast<size_t>((axis + 2) % 3)] = j;
    const auto [found, is_new] = index_of.try_emplace(key, static_cast<uint32_t>(box.mesh.vertices.size()));
    const auto coordinate = [&](size_t k) { return 2.0 * key[k] / n - 1; };
    if (is_new) box.mesh.vertices.push_back(to_float({coordinate(0), coordinate(1), coordinate(2)}));
    return found->second;
  };
  for (int face = 0; face < 6; ++face)
    for (int cell = 0; cell < n * n; ++cell) {
      const int axis = face / 2, side = face % 2, i = cell / n, j = cell % n;
      const uint32_t p = vertex(axis, side, i, j), q = vertex(axis, side, i + 1, j);
      const uint32_t r = vertex(axis, side, i + 1, j + 1), s = vertex(axis, side, i, j + 1);
      box.mesh.triangles.push_back(side ? Triangle{p, q, r} : Triangle{p, r, q});
      box.mesh.triangles.push_back(side ? Triangle{p, r, s} : Triangle{p, s, r});
    }
  return box;
}

NamedMesh closed_sphere(int n) {
  return mapped("closed_sphere", closed_box(n), [](Vec3d p) { return p == Vec3d{} ? p : normalized(p); });
}

NamedMesh noise_sphere(int n, Random& random) {
  NamedMesh sphere = closed_sphere(n);
  for (Vec3& vertex : sphere.mesh.vertices)
    vertex = to_float(snapped(to_double(vertex) * random.uniform(0.7, 1.3), 0x1p-10));
  sphere.name = "closed_noise_sphere";
  return sphere;
}

NamedMesh closed_torus(uint32_t around, uint32_t across) {
  NamedMesh torus{"closed_torus", {}, true, {1, 0, 0}};
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < across; ++j) {
      const SineCosine big = sine_cosine(2 * kPi * i / around), small = sine_cosine(2 * kPi * j / across);
      const double radius = 1 + 0.4 * small.cosine;
      torus.mesh.vertices.push_back(to_float({radius * big.cosine, radius * big.sine, 0.4 * small.sine}));
      const uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
      const uint32_t p = i * across + j, q = i1 * across + j, r = i1 * across + j1, s = i * across + j1;
      torus.mesh.triangles.push_back({p, q, r});
      torus.mesh.triangles.push_back({p, r, s});
    }
  return torus;
}

NamedMesh turned(std::string name, NamedMesh source, Random& random) {
  const Vec3d x = normalized(random_point(random, 1) + Vec3d{2, 0, 0});
  const Vec3d z = normalized(cross(x, random_point(random, 1) + Vec3d{0, 2, 0}));
  const Vec3d y = cross(z, x);
  return mapped(std::move(name), std::move(source), [&](Vec3d p) { return p.x * x + p.y * y + p.z * z; });
}

NamedMesh moved(std::string name, NamedMesh source, double scale, Vec3d offset) {
  return mapped(std::move(name), std::move(source), [&](Vec3d p) { return p * scale + offset; });
}

namespace {

/// Where an edge runs, by triangle and side.
struct Side {
  size_t triangle;
  size_t side;
};

/// Cuts triangle `t` into three at a vertex that lies nearly on one of its edges, or nearly in a corner.
void cut_in_three(TriangleMesh& mesh, size_t t, Random& random) {
  const Triangle old = mesh.triangles[t];
  const Vec3d a = to_double(mesh.vertices[old[0]]), b = to_double(mesh.vertices[old[1]]),
              c = to_double(mesh.vertices[old[2]]);
  const double thin = std::ldexp(1.0, -4 - static_cast<int>(random.below(20)));
  const double along = random.below(3) == 0 ? thin : random.uniform();
  const auto added = static_cast<uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(clamped_to_float(a + (b - a) * (along * (1 - thin)) + (c - a) * thin));
  mesh.triangles[t] = {old[0], old[1], added};
  mesh.triangles.push_back({old[1], old[2], added});
  mesh.triangles.push_back({old[2], old[0], added});
}

/// Cuts an edge, and the two triangles beside it, at a point near one of its ends.
void cut_edge(TriangleMesh& mesh, Side one, Side other, Random& random) {
  const Triangle t = mesh.triangles[one.triangle], s = mesh.triangles[other.triangle];
  const uint32_t from = t[one.side], to = t[(one.side + 1) % 3];
  const Vec3d p = to_double(mesh.vertices[from]), q = to_double(mesh.vertices[to]);
  const double share = random.below(2) ? 0.5 : std::ldexp(1.0, -2 - static_cast<int>(random.below(22)));
  const auto added = static_cast<uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(clamped_to_float(p + (q - p) * share));
  const uint32_t apex = t[(one.side + 2) % 3], below = s[(other.side + 2) % 3];
  mesh.triangles[one.triangle] = {from, added, apex};
  mesh.triangles[other.triangle] = {to, added, below};
  mesh.triangles.push_back({added, to, apex});
  mesh.triangles.push_back({added, from, below});
}

/// The other triangle that uses the edge, where there is exactly one.
bool find_opposite(const TriangleMesh& mesh, Side side, Side& opposite) {
  const Triangle t = mesh.triangles[side.triangle];
  const uint32_t from = t[side.side], to = t[(side.side + 1) % 3];
  size_t found = 0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    for (size_t k = 0; k < 3; ++k)
      if (mesh.triangles[i][k] == to && mesh.triangles[i][(k + 1) % 3] == from) {
        opposite = {i, k};
        ++found;
      }
  return found == 1 && opposite.triangle != side.triangle;
}

}  // namespace

NamedMesh with_slivers(NamedMesh source, size_t triangles, Random& random) {
  TriangleMesh& mesh = source.mesh;
  while (mesh.triangle_count() < triangles) {
    const Side side{random.below(mesh.triangle_count()), random.below(3)};
    Side opposite{};
    if (random.below(2) && find_opposite(mesh, side, opposite))
      cut_edge(mesh, side, opposite, random);
    else
      cut_in_three(mesh, side.triangle, random);
  }
  source.name += "_slivers";
  return source;
}

}  // namespace raygrain::shapes

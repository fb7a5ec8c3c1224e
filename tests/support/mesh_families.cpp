#include "support/mesh_families.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "base/random.h"
#include "base/trigonometry.h"

namespace raygrain::test {
namespace {

using Triangle = std::array<uint32_t, 3>;

Vec3d random_point(Random& random, double half_size) {
  const double x = random.uniform(-half_size, half_size);
  const double y = random.uniform(-half_size, half_size);
  return {x, y, random.uniform(-half_size, half_size)};
}

// Coordinates with few bits, so that many rays meet edges and vertices exactly.
Vec3d snapped(Vec3d p, double unit) {
  return {std::round(p.x / unit) * unit, std::round(p.y / unit) * unit, std::round(p.z / unit) * unit};
}

Vec3 clamped_to_float(Vec3d p) {
  constexpr double kMax = std::numeric_limits<float>::max();
  return to_float({std::clamp(p.x, -kMax, kMax), std::clamp(p.y, -kMax, kMax), std::clamp(p.z, -kMax, kMax)});
}

template <class Map>
NamedMesh mapped(std::string name, NamedMesh source, const Map& map) {
  for (Vec3& vertex : source.mesh.vertices) vertex = clamped_to_float(map(to_double(vertex)));
  source.inside = clamped_to_float(map(to_double(source.inside)));
  source.name = std::move(name);
  return source;
}

// The surface of the cube [-1, 1]^3, each face cut into n x n squares of two triangles; vertices are shared.
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

// Star-shaped about its centre; coordinates are multiples of 2^-10.
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

// A height field over [-1, 1]^2; heights are multiples of 2^-6 and many squares are flat.
NamedMesh open_grid(uint32_t n, Random& random) {
  NamedMesh grid{"open_grid", {}, false, {}};
  for (uint32_t i = 0; i <= n; ++i)
    for (uint32_t j = 0; j <= n; ++j) {
      const double height = random.below(2) ? 0 : random.uniform(-0.3, 0.3);
      grid.mesh.vertices.push_back(to_float(snapped({2.0 * i / n - 1, height, 2.0 * j / n - 1}, 0x1p-6)));
    }
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t j = 0; j < n; ++j) {
      const uint32_t p = i * (n + 1) + j, q = p + n + 1;
      grid.mesh.triangles.push_back({p, q, q + 1});
      grid.mesh.triangles.push_back({p, q + 1, p + 1});
    }
  return grid;
}

void add_triangle(TriangleMesh& mesh, Vec3d a, Vec3d b, Vec3d c) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  for (const Vec3d p : {a, b, c}) mesh.vertices.push_back(clamped_to_float(p));
  mesh.triangles.push_back({first, first + 1, first + 2});
}

NamedMesh soup(std::string name, size_t count, double size, Random& random) {
  NamedMesh result{std::move(name), {}, false, {}};
  for (size_t i = 0; i < count; ++i) {
    const Vec3d a = random_point(random, 1);
    const Vec3d b = a + random_point(random, size);
    add_triangle(result.mesh, a, b, a + random_point(random, size));
  }
  return result;
}

NamedMesh snapped_soup(size_t count, Random& random) {
  return mapped("soup_snapped", soup("", count, 0.7, random), [](Vec3d p) { return snapped(p, 0x1p-3); });
}

// Every coordinate with an exponent of its own, between the denormals and FLT_MAX.
NamedMesh mixed_exponents(size_t count, Random& random) {
  const auto coordinate = [&] {
    const double mantissa = random.uniform(-1, 1);
    return std::ldexp(mantissa, static_cast<int>(random.below(278)) - 149);
  };
  NamedMesh result{"mixed_exponents", {}, false, {}};
  for (size_t i = 0; i < 3 * count; ++i) {
    const double x = coordinate(), y = coordinate();
    result.mesh.vertices.push_back(clamped_to_float({x, y, coordinate()}));
    if (i % 3 == 2) result.mesh.triangles.push_back({uint32_t(i - 2), uint32_t(i - 1), uint32_t(i)});
  }
  return result;
}

NamedMesh one_triangle() {
  NamedMesh result{"one_triangle", {}, false, {}};
  add_triangle(result.mesh, {0, 0, 0}, {1, 0, 0.25}, {0, 1, 0.5});
  return result;
}

NamedMesh slivers(size_t count, Random& random) {
  NamedMesh result{"sliver", {}, false, {}};
  for (size_t i = 0; i < count; ++i) {
    const Vec3d a = random_point(random, 1), b = random_point(random, 1);
    const Vec3d on_edge = a + (b - a) * random.uniform();
    add_triangle(result.mesh, a, b, on_edge + random_point(random, 1e-6));
  }
  return result;
}

// Points, segments and repeated vertices, every third triangle good.
NamedMesh degenerate(size_t count, Random& random) {
  NamedMesh result{"degenerate", {}, false, {}};
  for (size_t i = 0; i < count; ++i) {
    const Vec3d a = snapped(random_point(random, 1), 0x1p-4), b = snapped(random_point(random, 1), 0x1p-4);
    const Vec3d c[] = {snapped(random_point(random, 1), 0x1p-4), a, b, (a + b) * 0.5, a + (b - a) * 2.0};
    add_triangle(result.mesh, a, i % 7 == 6 ? a : b, i % 3 == 0 ? c[0] : c[1 + random.below(4)]);
  }
  return result;
}

// Each triangle up to four times, some with the winding reversed or the corners turned.
NamedMesh duplicates(size_t count, Random& random) {
  NamedMesh result = soup("duplicates", count, 0.8, random);
  for (size_t i = 0; i < 3 * count; ++i) {
    const Triangle t = result.mesh.triangles[random.below(count)];
    result.mesh.triangles.push_back(random.below(2) ? Triangle{t[1], t[2], t[0]} : Triangle{t[0], t[2], t[1]});
  }
  return result;
}

std::vector<NamedMesh> closed_families(Random& random) {
  const Vec3d far{1e6, -1e6, 1e6};
  std::vector<NamedMesh> all;
  all.push_back(closed_box(4));
  all.push_back(turned("closed_box_turned", closed_box(3), random));
  all.push_back(closed_sphere(5));
  all.push_back(closed_torus(16, 10));
  all.push_back(turned("closed_torus_turned", closed_torus(12, 8), random));
  all.push_back(noise_sphere(5, random));
  all.push_back(moved("closed_scaled_1e-30", noise_sphere(4, random), 1e-30, {}));
  all.push_back(moved("closed_scaled_1e-6", noise_sphere(4, random), 1e-6, {1e-6, 0, 0}));
  all.push_back(moved("closed_scaled_1e6", noise_sphere(4, random), 1e6, {}));
  all.push_back(moved("closed_moved_1e6", closed_sphere(4), 1, far));
  all.push_back(moved("closed_scaled_moved_1e6", noise_sphere(4, random), 10, far));
  return all;
}

}  // namespace

std::vector<NamedMesh> mesh_families(uint64_t seed) {
  Random random(seed);
  std::vector<NamedMesh> all = closed_families(random);
  all.push_back(open_grid(12, random));
  all.push_back({"empty", {}, false, {}});
  all.push_back(one_triangle());
  all.push_back(slivers(60, random));
  all.push_back(degenerate(120, random));
  all.push_back(duplicates(60, random));
  all.push_back(moved("huge", soup("", 80, 0.5, random), 1e30, {}));
  all.push_back(moved("near_float_max", soup("", 80, 1, random), 3.4e38, {}));
  all.push_back(moved("tiny", soup("", 80, 0.5, random), 1e-41, {}));
  all.push_back(moved("far", soup("", 100, 0.5, random), 4, {3e6, 2e6, -1e6}));
  all.push_back(soup("large_triangles", 60, 4, random));
  all.push_back(soup("soup", 200, 0.3, random));
  all.push_back(snapped_soup(150, random));
  all.push_back(mixed_exponents(60, random));
  return all;
}

uint64_t seed_count(uint64_t usual) {
  const char* scale = std::getenv("RAYGRAIN_TEST_SCALE");
  const std::string name = scale ? scale : "";
  if (name == "full") return 10 * usual;
  return name == "small" ? std::max<uint64_t>(usual / 4, 1) : usual;
}

}  // namespace raygrain::test

#include <array>
#include <cmath>

#include "base/trigonometry.h"
#include "families/shapes.h"

namespace raygrain::shapes {

namespace {

using Triangle = std::array<uint32_t, 3>;

void add_triangle(TriangleMesh& mesh, Vec3d a, Vec3d b, Vec3d c) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  for (const Vec3d p : {a, b, c}) mesh.vertices.push_back(clamped_to_float(p));
  mesh.triangles.push_back({first, first + 1, first + 2});
}

}  // namespace

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

NamedMesh degenerate(size_t count, Random& random) {
  NamedMesh result{"degenerate", {}, false, {}};
  for (size_t i = 0; i < count; ++i) {
    const Vec3d a = snapped(random_point(random, 1), 0x1p-4), b = snapped(random_point(random, 1), 0x1p-4);
    const Vec3d c[] = {snapped(random_point(random, 1), 0x1p-4), a, b, (a + b) * 0.5, a + (b - a) * 2.0};
    add_triangle(result.mesh, a, i % 7 == 6 ? a : b, i % 3 == 0 ? c[0] : c[1 + random.below(4)]);
  }
  return result;
}

NamedMesh duplicates(size_t count, Random& random) {
  NamedMesh result = soup("duplicates", count, 0.8, random);
  for (size_t i = 0; i < 3 * count; ++i) {
    const Triangle t = result.mesh.triangles[random.below(count)];
    result.mesh.triangles.push_back(random.below(2) ? Triangle{t[1], t[2], t[0]} : Triangle{t[0], t[2], t[1]});
  }
  return result;
}

NamedMesh layers(size_t count, Random& random) {
  NamedMesh result{"layers", {}, false, {}};
  const bool is_flat = random.below(2) != 0;
  const int axis = static_cast<int>(random.below(3));
  for (size_t i = 0; i < count; ++i) {
    Vec3d corners[3];
    const double height = std::round(random.uniform(-1, 1) * 8) / 8;
    for (Vec3d& corner : corners) {
      corner = random_point(random, 1);
      corner[axis] = is_flat ? height : height + 0.01 * corner[axis];
    }
    add_triangle(result.mesh, corners[0], corners[1], corners[2]);
  }
  return result;
}

NamedMesh fan(size_t count, Random& random) {
  NamedMesh result{"fan", {}, false, {}};
  result.mesh.vertices.push_back({0, 0.25f, 0});
  for (size_t i = 0; i <= count; ++i) {
    const SineCosine turn = sine_cosine(2 * kPi * static_cast<double>(i) / static_cast<double>(count));
    const double radius = random.below(4) ? 1 : 0.01;
    result.mesh.vertices.push_back(clamped_to_float({radius * turn.cosine, 0, radius * turn.sine}));
    if (i > 0) result.mesh.triangles.push_back({0, static_cast<uint32_t>(i), static_cast<uint32_t>(i + 1)});
  }
  return result;
}

}  // namespace raygrain::shapes

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "raygrain/families.h"

#include "families/shapes.h"

namespace raygrain {

using namespace shapes;

namespace {

/// Side of a square, or of a cube's faces, of about so many triangles each.
int side_of(size_t triangles, size_t per_cell) {
  const size_t cells = triangles / per_cell;
  return std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(cells)))));
}

NamedMesh torus_of(size_t triangles) {
  const int side = std::max(3, side_of(triangles, 2));
  return closed_torus(static_cast<uint32_t>(side), static_cast<uint32_t>(side));
}

constexpr uint64_t kClosedShapes = 7;

NamedMesh closed_shape(uint64_t kind, size_t triangles, Random& random) {
  const int n = side_of(triangles, 12);
  switch (kind) {
    case 0:
      return closed_box(n);
    case 1:
      return closed_sphere(n);
    case 2:
      return torus_of(triangles);
    case 3:
      return noise_sphere(n, random);
    case 4:
      return with_slivers(closed_box(1), triangles, random);
    case 5:
      return with_slivers(noise_sphere(side_of(triangles / 2, 12), random), triangles, random);
    default:
      return with_slivers(torus_of(triangles / 2), triangles, random);
  }
}

NamedMesh turned_about(NamedMesh source, Random& random) {
  const std::string name = source.name + "_turned";
  return turned(name, std::move(source), random);
}

/// What is small is not moved far away: nothing of it would be left.
NamedMesh placed(NamedMesh source, double scale, bool far) {
  const double shift = far ? 1e6 : 0;
  const std::string name = source.name +
                           (scale == 1 ? "" : "_scaled_1e" + std::to_string(std::lround(std::log10(scale)))) +
                           (far ? "_moved_1e6" : "");
  return scale == 1 && !far ? source : moved(name, std::move(source), scale, {shift, -shift, shift});
}

constexpr uint64_t kOpenShapes = 13;

NamedMesh open_shape(uint64_t kind, size_t triangles, Random& random) {
  switch (kind) {
    case 0:
      return open_grid(static_cast<uint32_t>(side_of(triangles, 2)), random);
    case 1:
      return one_triangle();
    case 2:
      return slivers(triangles, random);
    case 3:
      return degenerate(triangles, random);
    case 4:
      return duplicates(std::max<size_t>(triangles / 4, 1), random);
    case 5:
      return moved("huge", soup("", triangles, 0.5, random), 1e30, {});
    case 6:
      return moved("near_float_max", soup("", triangles, 1, random), 3.4e38, {});
    case 7:
      return moved("tiny", soup("", triangles, 0.5, random), 1e-41, {});
    case 8:
      return moved("far", soup("", triangles, 0.5, random), 4, {3e6, 2e6, -1e6});
    case 9:
      return soup("large_triangles", triangles, 4, random);
    case 10:
      return layers(triangles, random);
    case 11:
      return fan(triangles, random);
    default:
      return mixed_exponents(triangles, random);
  }
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

std::vector<NamedMesh> closed_mesh_families(uint64_t seed) {
  Random random(seed);
  std::vector<NamedMesh> all;
  for (uint64_t kind = 0; kind < kClosedShapes; ++kind)
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6})
      for (const bool far : {false, true}) {
        if (far && scale < 1) continue;
        NamedMesh shape = closed_shape(kind, 40 + random.below(160), random);
        if (random.below(2)) shape = turned_about(std::move(shape), random);
        all.push_back(placed(std::move(shape), scale, far));
      }
  return all;
}

NamedMesh random_family_mesh(size_t triangles, uint64_t seed) {
  Random random(seed);
  const uint64_t kind = random.below(22);
  if (kind == 0) return soup("soup", triangles, 0.3, random);
  if (kind == 1) return snapped_soup(triangles, random);
  if (kind < 2 + kOpenShapes) return open_shape(kind - 2, triangles, random);
  NamedMesh shape = closed_shape(kind - 2 - kOpenShapes, triangles, random);
  if (random.below(3) == 0) shape = turned_about(std::move(shape), random);
  const double scales[] = {1, 1, 1, 1, 1e-30, 1e-6, 1e-3, 10, 1e3, 1e6};
  const double scale = scales[random.below(std::size(scales))];
  return placed(std::move(shape), scale, scale >= 1 && random.below(4) == 0);
}

}  // namespace raygrain

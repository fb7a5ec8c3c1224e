#include "families/aim.h"

#include <algorithm>
#include <cmath>

#include "families/shapes.h"

namespace raygrain {

using shapes::clamped_to_float;

Aim::Aim(const TriangleMesh& mesh, uint64_t seed) : mesh_(mesh), random(seed) {
  const Bounds bounds = mesh_bounds(mesh);
  if (is_empty(bounds)) return;
  middle_ = (to_double(bounds.lo) + to_double(bounds.hi)) * 0.5;
  half_ = (to_double(bounds.hi) - to_double(bounds.lo)) * 0.5;
  size_ = std::max({half_.x, half_.y, half_.z});
  if (size_ > 0) unit_ = std::ldexp(1.0, std::ilogb(size_) - 10);
  half_ = half_ + Vec3d{size_, size_, size_} * 0.5;
}

Vec3d Aim::place() {
  const Vec3d p = middle_ + Vec3d{signed_uniform() * half_.x, signed_uniform() * half_.y, signed_uniform() * half_.z};
  if (random.below(2)) return to_double(clamped_to_float(p));
  const auto snap = [&](double x) { return std::round(x / unit_) * unit_; };
  return to_double(clamped_to_float({snap(p.x), snap(p.y), snap(p.z)}));
}

Vec3d Aim::direction() {
  const double x = signed_uniform(), y = signed_uniform();
  return {x, y, signed_uniform() + 1e-3};
}

std::array<Vec3d, 3> Aim::triangle() {
  if (mesh_.triangles.empty()) return {place(), place(), place()};
  const size_t i = random.below(mesh_.triangle_count());
  return {to_double(mesh_.vertex(i, 0)), to_double(mesh_.vertex(i, 1)), to_double(mesh_.vertex(i, 2))};
}

Vec3d Aim::edge_point() {
  const auto [a, b, c] = triangle();
  return a + (b - a) * (random.below(2) ? 0.5 : random.uniform());
}

Vec3d Aim::surface_point() {
  const auto [a, b, c] = triangle();
  const double s = random.uniform(), t = random.uniform() * (1 - s);
  return a + (b - a) * s + (c - a) * t;
}

Vec3d Aim::target() {
  const uint64_t kind = random.below(3);
  return kind == 0 ? vertex() : (kind == 1 ? edge_point() : surface_point());
}

Ray Aim::towards(Vec3d target) {
  const Vec3 origin = clamped_to_float(place());
  return {origin, clamped_to_float(target - to_double(origin))};
}

}  // namespace raygrain

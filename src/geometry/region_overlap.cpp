// Separating axes. Any axis that separates proves "no overlap", however it was rounded; only the projections must be
// compared with their rounding error (docs/theory-areas.md). Every comparison is false for NaN, so doubt means "yes".
#include <cmath>
#include <span>

#include "raygrain/region.h"

namespace raygrain {

namespace {

struct Interval {
  double lo = std::numeric_limits<double>::infinity(), hi = -std::numeric_limits<double>::infinity();
};

Interval project(std::span<const Vec3d> points, Vec3d axis) {
  Interval result;
  for (const Vec3d p : points) {
    const double value = dot(axis, p);
    result.lo = value < result.lo ? value : result.lo;
    result.hi = value > result.hi ? value : result.hi;
  }
  return result;
}

double one_norm(Vec3d v) {
  return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
}

double largest_component(std::span<const Vec3d> points) {
  double largest = 0;
  for (const Vec3d p : points)
    largest = std::fmax(largest, std::fmax(std::fabs(p.x), std::fmax(std::fabs(p.y), std::fabs(p.z))));
  return largest;
}

// A convex point set against the region with its outer corners, both relative to the region's middle.
class AxisTest {
 public:
  AxisTest(const ConvexRegion& region, std::span<Vec3d> points) : points_(points) {
    const Vec3d middle = region.corners[0] * 0.5 + region.corners[7] * 0.5;
    for (size_t i = 0; i < 8; ++i) region_[i] = region.outer_corners[i] - middle;
    for (Vec3d& p : points_) p = p - middle;
    scale_ = std::fmax(largest_component(points_), largest_component(region_));
  }

  bool separates(Vec3d axis) const {
    const Interval a = project(points_, axis), b = project(region_, axis);
    const double rounding = 0x1p-48 * one_norm(axis) * scale_;
    return a.lo - b.hi > rounding || b.lo - a.hi > rounding;
  }

 private:
  std::span<Vec3d> points_;
  std::array<Vec3d, 8> region_;
  double scale_ = 0;
};

}  // namespace

bool overlaps(const ConvexRegion& region, Vec3 a, Vec3 b, Vec3 c) {
  std::array<Vec3d, 3> points{to_double(a), to_double(b), to_double(c)};
  const std::array<Vec3d, 3> sides{points[1] - points[0], points[2] - points[1], points[0] - points[2]};
  const AxisTest test(region, points);
  for (const Plane& plane : region.planes)
    if (test.separates(plane.normal)) return false;
  if (test.separates(cross(sides[0], sides[1]))) return false;
  for (int e = 0; e < region.edge_count; ++e)
    for (const Vec3d side : sides)
      if (test.separates(cross(region.edges[static_cast<size_t>(e)], side))) return false;
  return true;
}

bool overlaps(const ConvexRegion& region, const Bounds& box) {
  if (is_empty(box)) return false;
  constexpr std::array<Vec3d, 3> kAxes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  std::array<Vec3d, 8> points;
  for (int i = 0; i < 8; ++i) points[static_cast<size_t>(i)] = to_double(corner(box, i));
  const AxisTest test(region, points);
  for (const Vec3d axis : kAxes)
    if (test.separates(axis)) return false;
  for (const Plane& plane : region.planes)
    if (test.separates(plane.normal)) return false;
  for (int e = 0; e < region.edge_count; ++e)
    for (const Vec3d axis : kAxes)
      if (test.separates(cross(region.edges[static_cast<size_t>(e)], axis))) return false;
  return true;
}

}  // namespace raygrain

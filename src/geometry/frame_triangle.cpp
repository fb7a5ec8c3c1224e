#include "geometry/frame_triangle.h"

#include <algorithm>
#include <cmath>

#include "geometry/frame_polygon.h"

namespace raygrain {
namespace {

constexpr double kRoundoff = 0x1p-53;

using Edge = FrameTriangle::Edge;

/// The corners in local coordinates, each wrong by at most `error`, none larger than `size`.
struct LocalTriangle {
  std::array<Vec3d, 3> corners;
  double error, size;
};

double magnitude(Vec3d v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

LocalTriangle local_triangle(const RayFrame& frame, Vec3 a, Vec3 b, Vec3 c) {
  LocalTriangle local{};
  const std::array<Vec3, 3> corners{a, b, c};
  double distance = 0;
  for (size_t i = 0; i < 3; ++i) {
    local.corners[i] = to_local(frame, to_double(corners[i]));
    local.size = std::max(local.size, largest_component(local.corners[i]));
    distance = std::max(distance, largest_component(to_double(corners[i]) - frame.center));
  }
  local.error = 5 * kRoundoff * frame.norm * distance;
  return local;
}

/// From a normal that is wrong by at most `error` where it counts.
Edge scaled(double a, double b, double c, double error, double reach) {
  const double length = std::abs(a) + std::abs(b);
  if (!(length > 0 && error <= kEdgeError * reach * length)) return {};
  const Edge edge{a / length, b / length, c / length};
  // All of the domain lies on one side: the constant says so too, and keeps rounding errors small.
  if (std::abs(edge.c) > 4 * reach) return {0, 0, std::copysign(4 * reach, edge.c)};
  return edge;
}

/// The normal of the plane, wrong by at most `error` in each coordinate.
Vec3d plane_normal(const LocalTriangle& t, double& error) {
  const Vec3d ab = t.corners[1] - t.corners[0], ac = t.corners[2] - t.corners[0];
  const double length = std::max(largest_component(ab), largest_component(ac));
  error = 16 * t.error * (length + t.error) + 8 * kRoundoff * length * length;
  return cross(ab, ac);
}

void set_parallel_edges(const LocalTriangle& t, double reach, FrameTriangle& result) {
  double error = 0;
  const double area = plane_normal(t, error).z;
  if (!(std::abs(area) > error)) return;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3d p = t.corners[(k + 1) % 3], q = t.corners[(k + 2) % 3];
    const double a = area > 0 ? p.y - q.y : q.y - p.y, b = area > 0 ? q.x - p.x : p.x - q.x;
    const double lever = 2 * reach + std::abs(p.x) + std::abs(p.y), length = std::abs(a) + std::abs(b);
    result.edges[k] =
        scaled(a, b, -(a * p.x + b * p.y), (8 * t.error + 0x1p-48 * length) * lever + 2 * t.error * length, reach);
  }
}

void set_parallel_plane(const LocalTriangle& t, FrameTriangle& result) {
  double error = 0;
  const Vec3d normal = plane_normal(t, error), a = t.corners[0];
  if (!(std::abs(normal.z) > 4 * error)) return;
  const double p = -normal.x / normal.z, q = -normal.y / normal.z, lean = 1 + std::abs(p) + std::abs(q);
  double length = 0;
  for (const Vec3d corner : t.corners) length = std::max(length, largest_component(corner - a));
  const double r = a.z - p * a.x - q * a.y;
  result.p = p;
  result.q = q;
  result.r = r;
  result.z_error = 4 * lean * length * error / std::abs(normal.z) + 4 * lean * t.error + 0x1p-49 * lean * t.size;
}

void set_projective(const LocalTriangle& t, double reach, FrameTriangle& result) {
  const auto& [a, b, c] = t.corners;
  const double product_error = 8 * t.error * t.size + 8 * kRoundoff * t.size * t.size, around = 2 * reach + 1;
  const double determinant = dot(a, cross(b, c));
  if (!(std::abs(determinant) > 8 * t.size * (product_error + t.error * t.size))) return;
  const double sign = determinant > 0 ? 1 : -1;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3d normal = cross(t.corners[(k + 1) % 3], t.corners[(k + 2) % 3]) * sign;
    result.edges[k] =
        scaled(normal.x, normal.y, normal.z, product_error * around + 0x1p-49 * magnitude(normal) * around, reach);
  }
  double normal_error = 0;
  const Vec3d normal = plane_normal(t, normal_error);
  const double distance = dot(normal, a);  // of the eye from the plane, times |normal|
  const double distance_error = 4 * (t.size * normal_error + magnitude(normal) * (t.error + kRoundoff * t.size));
  if (!(std::abs(distance) > 4 * distance_error)) return;
  result.p = -normal.x / distance;
  result.q = -normal.y / distance;
  result.r = -normal.z / distance;
  const double most = (std::abs(result.p) + std::abs(result.q)) * reach + std::abs(result.r);
  result.z_error = 2 * (normal_error * around + most * distance_error) / std::abs(distance) + 0x1p-49 * most;
}

}  // namespace

FrameTriangle frame_triangle(const RayFrame& frame, Vec3 a, Vec3 b, Vec3 c, const Bounds& box, double reach) {
  const LocalTriangle local = local_triangle(frame, a, b, c);
  FrameTriangle result;
  result.z_error = std::numeric_limits<double>::infinity();
  if (frame.is_projective()) {
    set_projective(local, reach, result);
  } else {
    set_parallel_edges(local, reach, result);
    set_parallel_plane(local, result);
  }
  const double lo = box.lo.z, hi = box.hi.z, half = 0.5 * (hi - lo);
  constexpr double kFloatError = 0x1p-21;  // of p, q, r in float, and of p x + q y + r
  result.z_error += kFloatError * ((std::abs(result.p) + std::abs(result.q)) * reach + std::abs(result.r));
  const double flat_error = half + kFloatError * std::max(std::abs(lo), std::abs(hi));
  if (result.z_error <= 2 * flat_error) return result;
  result = {};  // beyond the box the triangle may be at other depths, so it must never be sure
  result.r = 0.5 * (lo + hi);
  result.z_error = flat_error;
  return result;
}

}  // namespace raygrain

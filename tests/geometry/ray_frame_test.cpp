// Ray space against long double, whose rounding is 2^11 times finer than the errors that the frames allow for.
#include "raygrain/ray_frame.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "raygrain/error.h"

#include "geometry/area_support.h"
#include "geometry/frame_support.h"
#include "geometry/region_support.h"
#include "support/mesh_families.h"

namespace raygrain {
namespace {

using test::for_frames;

using Real = Vector3<long double>;

Real real(Vec3 p) {
  return {p.x, p.y, p.z};
}
Real real(Vec3d p) {
  return {p.x, p.y, p.z};
}

Real image(const RayFrame& frame, Real p) {
  const Real v = p - real(frame.center);
  const Real q{dot(real(frame.rows[0]), v), dot(real(frame.rows[1]), v), dot(real(frame.rows[2]), v)};
  return frame.is_projective() ? Real{q.x / q.z, q.y / q.z, -1 / q.z} : q;
}
long double depth(const RayFrame& frame, Real p) {
  return dot(real(frame.rows[2]), p - real(frame.center));
}
bool is_in(const Bounds& box, Real p) {
  for (int k = 0; k < 3; ++k)
    if (!(static_cast<long double>(box.lo[k]) <= p[k] && p[k] <= static_cast<long double>(box.hi[k]))) return false;
  return true;
}
bool is_shown(const RayFrame& frame, Real p) {
  return !frame.is_projective() || depth(frame, p) >= static_cast<long double>(frame.near_z);
}

Vec3 some_point(const AreaGeometry& area, Random& random) {
  const Vec3d inside = test::point_inside(area.region(), random);
  const double away = test::diameter(area.region()) * std::pow(10.0, random.uniform(-3, 0.5));
  return to_float(random.below(2) ? inside : inside + test::random_vector(random) * away);
}

TEST(RayFrame, BoundsHoldTheTriangle) {
  size_t points = 0;
  for_frames(300, [&](const RayFrame& frame, const AreaGeometry& area, Random& random) {
    for (int i = 0; i < 40; ++i) {
      const Vec3 a = some_point(area, random);
      const double size = test::diameter(area.region()) * std::pow(10.0, random.uniform(-4, 0.3));
      const Vec3 b = to_float(to_double(a) + test::random_vector(random) * size);
      const Vec3 c = random.below(8) == 0 ? b : to_float(to_double(a) + test::random_vector(random) * size);
      const Bounds box = frame_bounds(frame, a, b, c);
      Bounds world;
      for (const Vec3 p : {a, b, c}) world.extend(p);
      const Bounds whole = frame_bounds(frame, world);
      Bounds part = frame.domain;
      const int axis = static_cast<int>(random.below(3));
      if (!is_empty(box)) part.hi[axis] = box.lo[axis] * 0.4f + box.hi[axis] * 0.6f;
      const Bounds clipped = frame_bounds(frame, a, b, c, part);
      for (int k = 0; k < 20; ++k) {
        long double s = random.uniform(), t = random.uniform() * static_cast<double>(1 - s);
        if (k < 3) s = k == 1, t = k == 2;
        const Real p = real(a) + (real(b) - real(a)) * s + (real(c) - real(a)) * t;
        if (!is_shown(frame, p)) continue;
        const Real q = image(frame, p);
        if (!is_in(frame.domain, q)) continue;
        ++points;
        ASSERT_TRUE(is_in(box, q)) << i;
        ASSERT_TRUE(is_in(whole, q)) << i;
        ASSERT_TRUE(!is_in(part, q) || is_in(clipped, q)) << i;
      }
    }
  });
  EXPECT_GT(points, 1000u);
}

/// Along the area's rays, nearly so, or anywhere; from inside the region.
Ray some_ray(const AreaGeometry& area, Random& random) {
  const Vec3 origin = to_float(test::point_inside(area.region(), random));
  Vec3d along = area.ray_direction(to_double(origin));
  const double lean = std::pow(10.0, random.uniform(-9, 0));
  if (random.below(3) == 0) along = along + test::random_vector(random) * (length(along) * lean);
  const double stretch = std::pow(10.0, random.uniform(-2, 2)) * (random.below(2) ? 1 : -1);
  Ray ray{origin, to_float(along * stretch)};
  if (random.below(3) == 0) ray.tmin = static_cast<float>(random.uniform(-1, 1));
  if (random.below(3) == 0) ray.tmax = ray.tmin + static_cast<float>(random.uniform(0, 2));
  if (ray.tmin > ray.tmax) ray.tmax = ray.tmin;
  if (random.below(16) == 0) ray.tmin = -kInf;
  return ray;
}

std::array<float, 2> depths_of(const RayFrame& frame, const AreaGeometry& area) {
  if (frame.is_projective()) return {frame.domain.lo.z, frame.domain.hi.z};
  const auto size = static_cast<float>(2 * test::diameter(area.region()));
  return {-size, size};
}

TEST(RayFrame, SegmentsAndColumnsHoldTheRay) {
  size_t points = 0, sure_points = 0, tight = 0, columns = 0;
  for_frames(400, [&](const RayFrame& frame, const AreaGeometry& area, Random& random) {
    for (int i = 0; i < 60; ++i) {
      const Ray ray = some_ray(area, random);
      if (!is_valid(ray)) continue;
      const std::array<float, 2> depths = depths_of(frame, area);
      FrameSegment s;
      const FrameFit fit = make_segment(frame, ray, depths, s);
      if (fit == FrameFit::kUnfit) continue;
      const FrameColumn column = to_column(s);
      const double size = test::diameter(area.region()), speed = length(to_double(ray.direction));
      const double first = std::max<double>(ray.tmin, -2 * size / speed);
      const double last = std::min<double>(ray.tmax, 2 * size / speed);
      for (int k = 0; k < 12 && first <= last; ++k) {
        const auto t = static_cast<long double>(k == 0 ? first : k == 1 ? last : random.uniform(first, last));
        const Real p = real(ray.origin) + real(ray.direction) * t;
        if (!is_shown(frame, p)) continue;
        const Real q = image(frame, p);
        if (!(static_cast<long double>(depths[0]) <= q.z && q.z <= static_cast<long double>(depths[1]))) continue;
        ++points;
        ASSERT_EQ(fit, FrameFit::kServed);
        const long double away = q.z - s.z0, error = s.error;
        ASSERT_LE(std::abs(q.x - (s.x0 + s.slope_x * away)), error) << i << ' ' << k;
        ASSERT_LE(std::abs(q.y - (s.y0 + s.slope_y * away)), error);
        ASSERT_TRUE(s.z_lo <= q.z && q.z <= s.z_hi);
        ASSERT_TRUE(is_in(column.box, q));
        ASSERT_EQ(s.ascending, dot(real(frame.rows[2]), real(ray.direction)) > 0);
        const auto next = static_cast<long double>(std::nextafter(static_cast<float>(t), kInf));
        const Real neighbour = real(ray.origin) + real(ray.direction) * next;
        if (is_shown(frame, neighbour)) {
          ASSERT_LE(std::abs(image(frame, neighbour).z - q.z), s.tie(static_cast<double>(q.z)));
          ASSERT_LE(std::abs(image(frame, neighbour).z - q.z), s.tie(static_cast<double>(image(frame, neighbour).z)));
        }
      }
      if (fit != FrameFit::kServed) continue;
      ++columns;
      tight += static_cast<double>(column.radius) <
               1e-6 * (1 + std::abs(static_cast<double>(column.x)) + std::abs(static_cast<double>(column.y)));
      ASSERT_LE(column.x - column.radius, column.box.lo.x);
      ASSERT_GE(column.y + column.radius, column.box.hi.y);
      for (int k = 0; k < 4 && s.sure_lo <= s.sure_hi; ++k) {
        const double z = k == 0 ? s.sure_lo : k == 1 ? s.sure_hi : random.uniform(s.sure_lo, s.sure_hi);
        if (frame.is_projective() && z == 0) continue;  // at infinity
        const long double d = frame.is_projective() ? -1 / static_cast<long double>(z) : static_cast<long double>(z);
        const long double t = (d - depth(frame, real(ray.origin))) / dot(real(frame.rows[2]), real(ray.direction));
        const long double slack = 0x1p-58L * std::abs(t);
        ASSERT_GE(t + slack, static_cast<long double>(ray.tmin));
        ASSERT_LE(t - slack, static_cast<long double>(ray.tmax));
        ++sure_points;
      }
    }
  });
  EXPECT_GT(points, 10000u);
  EXPECT_GT(sure_points, 10000u);
  EXPECT_GT(tight, columns / 4);
}

TEST(RayFrame, RaysOfAnAreaAreColumns) {
  for_frames(100, [&](const RayFrame& frame, const AreaGeometry& area, Random& random) {
    if (frame.is_projective()) return;
    const Ray ray{to_float(test::point_inside(area.region(), random)), to_float(area.frame().forward)};
    FrameSegment s;
    ASSERT_EQ(make_segment(frame, ray, depths_of(frame, area), s), FrameFit::kServed);
    ASSERT_LE(drift(s), 1e-6 * test::diameter(area.region()));
  });
}

// A compiler that leaves out the rounding makes other frames than one that does not.
TEST(RayFrame, CentersOfParallelRaysAreFloats) {
  for_frames(20, [](const RayFrame& frame, const AreaGeometry&, Random&) {
    if (frame.is_projective()) return;
    for (int axis = 0; axis < 3; ++axis) {
      const volatile float rounded = static_cast<float>(frame.center[axis]);
      ASSERT_EQ(frame.center[axis], static_cast<double>(rounded));
    }
  });
}

// Its far face lies beyond the largest float, and so does its middle: a frame there would hold nothing, and say so.
TEST(RayFrame, NoneForAreasWithAMiddleBeyondFloats) {
  const InfluenceArea huge{"huge", PlaneArea{{0, -2.1e38f, 0}, {0, -1, 0}, {0, 0, 1}, 1e38f, 1e38f, 3e38f}};
  EXPECT_TRUE(frame_kinds(AreaGeometry(huge)).empty());
  const InfluenceArea large{"large", PlaneArea{{0, -1e38f, 0}, {0, -1, 0}, {0, 0, 1}, 1e38f, 1e38f, 3e38f}};
  EXPECT_FALSE(frame_kinds(AreaGeometry(large)).empty());
}

TEST(RayFrame, TheDomainHoldsTheRegion) {
  for_frames(100, [&](const RayFrame& frame, const AreaGeometry& area, Random& random) {
    for (int i = 0; i < 20; ++i)
      ASSERT_TRUE(is_in(frame.domain, image(frame, real(to_float(test::point_inside(area.region(), random))))));
  });
}

TEST(RayFrame, ShearsNeedTheirAxis) {
  EXPECT_FALSE(parallel_frame(FrameKind::kShearX, {0.05f, -1, 0.2f}, {}).has_value());
  EXPECT_TRUE(parallel_frame(FrameKind::kShearY, {0.05f, -1, 0.2f}, {}).has_value());
  EXPECT_TRUE(parallel_frame(FrameKind::kRotation, {0.05f, -1, 0.2f}, {}).has_value());
  EXPECT_FALSE(parallel_frame(FrameKind::kProjective, {0.05f, -1, 0.2f}, {}).has_value());
  EXPECT_THROW(parallel_frame(FrameKind::kRotation, {0, 0, 0}, {}), Error);
  EXPECT_THROW(parallel_frame(FrameKind::kShearY, {0, kInf, 0}, {}), Error);
  EXPECT_THROW(parallel_frame(FrameKind::kRotation, {0, 1, 0}, {kInf, 0, 0}), Error);
}

}  // namespace
}  // namespace raygrain

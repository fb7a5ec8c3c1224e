#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/rays.h"

#include "rays/statistics.h"
#include "support/fingerprint.h"

namespace raygrain {
namespace {

using test::bin;
using test::chi_square_deviation;
using test::fingerprint;

constexpr size_t kCount = 20000;
constexpr double kDegrees = std::numbers::pi / 180;

InfluenceArea oblique_plane() {
  return {"plane", PlaneArea{{3, 40, -7}, {0.35f, -0.8f, 0.48f}, {0, 1, 0}, 12, 5, 60}};
}
InfluenceArea vertical_plane() {
  return {"vertical", PlaneArea{{0, 10, 0}, {0, -1, 0}, {0, 1, 0}, 2, 3, 20}};
}
InfluenceArea oblique_point() {
  return {"point", PointArea{{-4, 9, 2}, {0.6f, -0.5f, 0.3f}, {0, 1, 0}, 90, 60, 0.5f, 80}};
}
InfluenceArea wide_point() {
  return {"wide", PointArea{{1000, -2000, 500}, {0, 0, -1}, {0, 1, 0}, 130, 45, 1, 4000}};
}
std::vector<InfluenceArea> all_areas() {
  return {oblique_plane(), vertical_plane(), oblique_point(), wide_point()};
}

bool same(const Ray& a, const Ray& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// Window coordinates of the ray's origin in [0, 1]^2, and its depth share.
Vec3d window_position(const AreaGeometry& geometry, const Ray& ray) {
  const Vec3d p = to_local(geometry.frame(), to_double(ray.origin));
  const Vec2d half = geometry.window_half();
  if (const auto* plane = std::get_if<PlaneArea>(&geometry.area().shape))
    return {(p.x / half.x + 1) / 2, (p.y / half.y + 1) / 2, p.z / plane->depth};
  const auto& point = std::get<PointArea>(geometry.area().shape);
  return {(p.x / p.z / half.x + 1) / 2, (p.y / p.z / half.y + 1) / 2,
          (p.z - point.near_z) / (static_cast<double>(point.far_z) - point.near_z)};
}

TEST(AreaRays, AreAllServed) {
  for (const InfluenceArea& area : all_areas())
    for (const RayStart start : {RayStart::kNear, RayStart::kRandomDepth})
      for (uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(area.name + " seed " + std::to_string(seed));
        const AreaGeometry geometry(area);
        for (const Ray& ray : cast_rays(AreaRays{area, start}, kCount, seed)) {
          ASSERT_TRUE(is_valid(ray));
          ASSERT_TRUE(geometry.serves(ray));
        }
      }
}

TEST(AreaRays, AreUniformInTheWindow) {
  for (const InfluenceArea& area : all_areas())
    for (uint64_t seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(area.name + " seed " + std::to_string(seed));
      const AreaGeometry geometry(area);
      std::vector<size_t> counts(256);
      for (const Ray& ray : cast_rays(AreaRays{area}, kCount, seed)) {
        const Vec3d at = window_position(geometry, ray);
        ASSERT_NEAR(at.z, 0, 1e-5);
        ++counts[bin(at.x, 16) * 16 + bin(at.y, 16)];
      }
      EXPECT_LT(std::abs(chi_square_deviation(counts)), 4.5);
    }
}

TEST(AreaRays, RandomDepthIsUniform) {
  for (const InfluenceArea& area : all_areas()) {
    SCOPED_TRACE(area.name);
    const AreaGeometry geometry(area);
    std::vector<size_t> depths(100), window(256);
    for (const Ray& ray : cast_rays(AreaRays{area, RayStart::kRandomDepth}, kCount, 9)) {
      const Vec3d at = window_position(geometry, ray);
      ++depths[bin(at.z, depths.size())];
      ++window[bin(at.x, 16) * 16 + bin(at.y, 16)];
    }
    EXPECT_LT(std::abs(chi_square_deviation(depths)), 4.5);
    EXPECT_LT(std::abs(chi_square_deviation(window)), 4.5);
  }
}

TEST(AreaRays, ParallelRaysShareTheExactDirection) {
  for (const InfluenceArea& area : {oblique_plane(), vertical_plane()}) {
    const Vec3 direction = std::get<PlaneArea>(area.shape).direction;
    const Vec3 expected = to_float(normalized(to_double(direction)));
    for (const Ray& ray : cast_rays(AreaRays{area}, 100, 1)) ASSERT_EQ(ray.direction, expected);
  }
}

TEST(AreaRays, PointRaysRunAlongTheLineThroughTheEye) {
  for (const InfluenceArea& area : {oblique_point(), wide_point()})
    for (const PointSpread spread : {PointSpread::kNearPlane, PointSpread::kAngle}) {
      const auto& point = std::get<PointArea>(area.shape);
      for (const Ray& ray : cast_rays(AreaRays{area, RayStart::kRandomDepth, spread}, 1000, 2)) {
        const Vec3d out = to_double(ray.origin) - to_double(point.eye), along = to_double(ray.direction);
        ASSERT_NEAR(length(along), 1, 1e-6);
        const double rounding = 1e-6 * length(to_double(ray.origin)) / length(out);
        ASSERT_LT(length(cross(out / length(out), along)), 1e-6 + rounding);
        ASSERT_GT(dot(out, along), 0);
      }
    }
}

// yaw ~ U(+-fov_x / 2), pitch ~ U(+-fov_y / 2) of (sin yaw cos pitch, -sin pitch, cos yaw cos pitch).
TEST(AreaRays, AngleSpreadIsUniformInYawAndPitch) {
  for (const InfluenceArea& area : {oblique_point(), wide_point()}) {
    SCOPED_TRACE(area.name);
    const AreaGeometry geometry(area);
    const auto& point = std::get<PointArea>(area.shape);
    std::vector<size_t> counts(256);
    size_t outside = 0;
    for (const Ray& ray : cast_rays(AreaRays{area, RayStart::kNear, PointSpread::kAngle}, kCount, 4)) {
      const Vec3d d = to_local_direction(geometry.frame(), to_double(ray.direction));
      const double yaw = std::atan2(d.x, d.z) / kDegrees, pitch = -std::asin(d.y) / kDegrees;
      ++counts[bin(yaw / point.fov_x + 0.5, 16) * 16 + bin(pitch / point.fov_y + 0.5, 16)];
      const Vec3d at = window_position(geometry, ray);
      ASSERT_NEAR(at.z * point.far_z, 0, 1e-3);
      outside += at.x < 0 || at.x > 1 || at.y < 0 || at.y > 1;
    }
    EXPECT_LT(std::abs(chi_square_deviation(counts)), 4.5);
    // Known shares of rays outside the window: 90 x 60 degrees 8.7 %, 130 x 45 degrees 19.1 %.
    EXPECT_NEAR(static_cast<double>(outside) / kCount, area.name == "wide" ? 0.191 : 0.087, 0.01);
  }
}

TEST(AreaRays, ConeIsUniformOnTheCap) {
  for (const float degrees : {2.0f, 30.0f, 90.0f})
    for (const InfluenceArea& area : {oblique_plane(), oblique_point()}) {
      SCOPED_TRACE(area.name + " cone " + std::to_string(degrees));
      AreaRays options{area};
      const std::vector<Ray> exact = cast_rays(options, kCount, 5);
      options.cone_degrees = degrees;
      const std::vector<Ray> spread = cast_rays(options, kCount, 5);
      const double cosine = std::cos(degrees * kDegrees);
      std::vector<size_t> heights(64), turns(64);
      for (size_t i = 0; i < kCount; ++i) {
        ASSERT_EQ(exact[i].origin, spread[i].origin);
        const Frame frame = make_frame({}, to_double(exact[i].direction), {});
        const Vec3d d = to_local_direction(frame, to_double(spread[i].direction));
        ASSERT_NEAR(length(d), 1, 1e-6);
        ASSERT_GE(d.z, cosine - 1e-6);
        // The height is measured by the sideways distance, which float directions keep better for narrow cones.
        const double height = 1 - std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y));
        ++heights[bin(height / (1 - cosine), heights.size())];
        ++turns[bin(std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 0.5, turns.size())];
      }
      EXPECT_LT(std::abs(chi_square_deviation(heights)), 4.5);
      EXPECT_LT(std::abs(chi_square_deviation(turns)), 4.5);
    }
}

TEST(AreaRays, JitterIsUniformOnTheDisc) {
  for (const InfluenceArea& area : {oblique_plane(), oblique_point()}) {
    SCOPED_TRACE(area.name);
    AreaRays options{area};
    const std::vector<Ray> exact = cast_rays(options, kCount, 6);
    options.jitter_radius = 3;
    const std::vector<Ray> moved = cast_rays(options, kCount, 6);
    const AreaGeometry geometry(area);
    std::vector<size_t> rings(64), turns(64);
    for (size_t i = 0; i < kCount; ++i) {
      ASSERT_EQ(exact[i].direction, moved[i].direction);
      const Vec3d d = to_local_direction(geometry.frame(), to_double(moved[i].origin) - to_double(exact[i].origin));
      ASSERT_NEAR(d.z, 0, 1e-4);
      ASSERT_LE(std::hypot(d.x, d.y), 3.0001);
      ++rings[bin((d.x * d.x + d.y * d.y) / 9, rings.size())];
      ++turns[bin(std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 0.5, turns.size())];
    }
    EXPECT_LT(std::abs(chi_square_deviation(rings)), 4.5);
    EXPECT_LT(std::abs(chi_square_deviation(turns)), 4.5);
  }
}

TEST(AreaRays, AreABeginningOfLongerSets) {
  const AreaRays options{oblique_point(), RayStart::kRandomDepth, PointSpread::kNearPlane, 3, 0.1f};
  const std::vector<Ray> many = cast_rays(options, 500, 8), few = cast_rays(options, 17, 8);
  ASSERT_EQ(few.size(), 17u);
  for (size_t i = 0; i < few.size(); ++i) EXPECT_TRUE(same(few[i], many[i]));
  EXPECT_TRUE(cast_rays(options, 0, 8).empty());
  size_t equal = 0;
  const std::vector<Ray> other = cast_rays(options, 500, 9);
  for (size_t i = 0; i < many.size(); ++i) equal += same(many[i], other[i]);
  EXPECT_EQ(equal, 0u);
}

// Streams of neighbouring indices and seeds must not be one stream, shifted.
TEST(AreaRays, NeighboursAreIndependent) {
  const AreaGeometry geometry(oblique_plane());
  const std::vector<Ray> rays = cast_rays(AreaRays{oblique_plane()}, kCount, 1);
  const std::vector<Ray> next_seed = cast_rays(AreaRays{oblique_plane()}, kCount, 2);
  std::vector<size_t> lagged(256), crossed(256), seeds(256);
  for (size_t i = 0; i + 1 < kCount; ++i) {
    const Vec3d a = window_position(geometry, rays[i]), b = window_position(geometry, rays[i + 1]);
    const Vec3d c = window_position(geometry, next_seed[i]);
    ++lagged[bin(a.x, 16) * 16 + bin(b.x, 16)];
    ++crossed[bin(a.y, 16) * 16 + bin(b.x, 16)];
    ++seeds[bin(a.x, 16) * 16 + bin(c.x, 16)];
  }
  EXPECT_LT(std::abs(chi_square_deviation(lagged)), 4.5);
  EXPECT_LT(std::abs(chi_square_deviation(crossed)), 4.5);
  EXPECT_LT(std::abs(chi_square_deviation(seeds)), 4.5);
}

// Literal, so that another machine, compiler or library that gives other bits is found out.
TEST(AreaRays, AreTheSameOnEveryMachine) {
  const AreaRays plane{oblique_plane(), RayStart::kRandomDepth, PointSpread::kNearPlane, 5, 0.25f};
  const AreaRays point{oblique_point(), RayStart::kNear, PointSpread::kAngle, 0, 0};
  EXPECT_EQ(fingerprint(cast_rays(plane, 64, 1)), 6589487954645818579u);
  EXPECT_EQ(fingerprint(cast_rays(point, 64, 1)), 6438630270694800709u);
}

TEST(AreaRays, RefuseOptionsOutOfRange) {
  const auto code = [](AreaRays options) {
    try {
      cast_rays(options, 1, 1);
    } catch (const Error& error) {
      return error.code;
    }
    return ErrorCode::kCancelled;
  };
  AreaRays options{oblique_plane()};
  for (const float cone : {-1.0f, 90.5f, NAN}) {
    options.cone_degrees = cone;
    EXPECT_EQ(code(options), ErrorCode::kUsage) << cone;
  }
  options.cone_degrees = 0;
  for (const float radius : {-1.0f, INFINITY, NAN}) {
    options.jitter_radius = radius;
    EXPECT_EQ(code(options), ErrorCode::kUsage) << radius;
  }
  AreaRays flat{oblique_plane()};
  std::get<PlaneArea>(flat.area.shape).half_width = 0;
  EXPECT_EQ(code(flat), ErrorCode::kBadArea);
}

TEST(AngularDirection, TurnsByYawThenPitch) {
  EXPECT_EQ(angular_direction(0, 0), (Vec3d{0, 0, 1}));
  for (double yaw = -80; yaw <= 80; yaw += 20)
    for (double pitch = -80; pitch <= 80; pitch += 20) {
      const Vec3d d = angular_direction(yaw * kDegrees, pitch * kDegrees);
      EXPECT_NEAR(length(d), 1, 1e-14);
      EXPECT_NEAR(std::atan2(d.x, d.z), yaw * kDegrees, 1e-14);
      EXPECT_NEAR(std::asin(d.y), -pitch * kDegrees, 1e-13);
    }
}

}  // namespace
}  // namespace raygrain

// Face weights of ray space and their limits: no tolerance is the column case, half a sphere of it surface area.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/ray_frame.h"

#include "base/trigonometry.h"
#include "geometry/area_support.h"
#include "geometry/frame_support.h"
#include "geometry/region_support.h"
#include "support/mesh_families.h"

namespace raygrain {
namespace {

using test::for_frames;

constexpr float kAll = 1 - 0x1p-24f;  // the greatest tolerance: half a sphere

AreaGeometry with_tolerance(const AreaGeometry& area, float tolerance) {
  InfluenceArea changed = area.area();
  changed.tolerance = tolerance;
  return AreaGeometry(changed);
}

double determinant(const RayFrame& frame) {
  return std::abs(dot(frame.rows[0], cross(frame.rows[1], frame.rows[2])));
}

/// Of the parallelepiped of the world that a frame's box is, from its corners.
double world_surface(const RayFrame& frame, Vec3d lo, Vec3d size) {
  const double volume = dot(frame.rows[0], cross(frame.rows[1], frame.rows[2]));
  std::array<Vec3d, 3> columns;  // of the inverse map
  for (size_t k = 0; k < 3; ++k) columns[k] = cross(frame.rows[(k + 1) % 3], frame.rows[(k + 2) % 3]) / volume;
  const auto corner = [&](int i) {
    const Vec3d q{lo.x + ((i & 1) != 0 ? size.x : 0), lo.y + ((i & 2) != 0 ? size.y : 0),
                  lo.z + ((i & 4) != 0 ? size.z : 0)};
    const Vec3d p = frame.center + columns[0] * q.x + columns[1] * q.y + columns[2] * q.z;
    EXPECT_LT(length(to_frame(frame, p) - q), 1e-12 * (1 + length(q) + length(frame.center)));
    return p;
  };
  double surface = 0;
  constexpr int kFaces[6][4] = {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};
  for (const auto& face : kFaces) {
    const Vec3d a = corner(face[0]), b = corner(face[1]), c = corner(face[2]), d = corner(face[3]);
    surface += 0.5 * length(cross(b - a, c - a)) + 0.5 * length(cross(b - d, c - d));
  }
  return surface;
}

// A convex body's shadow averages a quarter of its surface over all directions (Cauchy).
TEST(FrameWeights, OfAllDirectionsAreTheWorldsSurface) {
  size_t sheared = 0;
  for_frames(60, [&](const RayFrame& frame, const AreaGeometry& area, Random& random) {
    if (frame.is_projective()) return;
    const Vec3d w = frame_area_weights(frame, with_tolerance(area, kAll));
    std::vector<Vec3> all;
    while (all.size() < 20000) {
      const Vec3d v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      if (dot(v, v) <= 1 && dot(v, v) > 0.01) all.push_back(to_float(v));
    }
    const Vec3d drawn = frame_face_weights(frame, all);
    if (frame.kind == FrameKind::kRotation) {  // surface area of turned boxes
      ASSERT_NEAR(w.x, 0.5, 0.003);
      ASSERT_NEAR(w.y, 0.5, 0.003);
      ASSERT_NEAR(w.z, 0.5, 0.003);
    }
    sheared += frame.kind != FrameKind::kRotation;
    for (int i = 0; i < 8; ++i) {
      const Vec3d lo = test::random_vector(random),
                  size{random.uniform(0.1, 2), random.uniform(0.1, 2), i == 0 ? 0 : random.uniform(0.1, 2)};
      const double quarter = 0.25 * world_surface(frame, lo, size);
      const Vec3d faces{size.y * size.z, size.z * size.x, size.x * size.y};
      ASSERT_NEAR(dot(w, faces), quarter, 0.005 * quarter);
      ASSERT_NEAR(dot(drawn, faces), quarter, 0.025 * quarter);
    }
  });
  EXPECT_GT(sheared, 10u);
}

constexpr float kShrinking[] = {1e-2f, 1e-3f, 1e-4f, 1e-5f, 1e-6f, 1e-7f, 1e-8f, 1e-9f};

// As the tolerance shrinks, the cone becomes the column, and is the column at 0.
TEST(FrameWeights, ConvergeToTheColumns) {
  for_frames(60, [&](const RayFrame& frame, const AreaGeometry& area, Random&) {
    const Vec3d column =
        frame.is_projective() ? Vec3d{0, 0, 1} : frame_face_weights(frame, std::vector{to_float(area.frame().forward)});
    ASSERT_EQ(frame_area_weights(frame, with_tolerance(area, 0)), column);
    ASSERT_LT(column.x + column.y, 1e-6 * column.z);
    Vec3d last{1e30, 1e30, 1e30};
    double last_away = 1e30;
    const Vec2d half = area.window_half();
    const double widest = frame.is_projective() ? std::atan(std::hypot(half.x, half.y)) : 0;
    for (const float tolerance : kShrinking) {
      // Rays that lean out of the frame do not count: a wide window's cones shrink into it first.
      if (widest + std::acos(1 - static_cast<double>(tolerance)) > 1.569) continue;
      const Vec3d w = frame_area_weights(frame, with_tolerance(area, tolerance));
      const double away = length(w - column);
      ASSERT_LT(w.x, last.x) << tolerance;
      ASSERT_LT(w.y, last.y) << tolerance;
      ASSERT_LT(away, 0.4 * last_away) << tolerance;
      ASSERT_GT(away, 0);
      last = w, last_away = away;
    }
    if (last_away == 1e30) return;  // near the window's corners no ray counts
    const double size = frame.is_projective() ? frame.near_z * (1 + half.x * half.x + half.y * half.y)
                                              : frame.norm / determinant(frame);
    ASSERT_LT(last_away, 1e-4 * size);
  });
}

// Of a cap of half angle a the mean sideways part is 2/3 a across, and 2/pi of that along one axis.
TEST(FrameWeights, OfNarrowConesFollowTheirAngle) {
  for_frames(60, [&](const RayFrame& frame, const AreaGeometry& area, Random&) {
    if (frame.is_projective()) return;
    for (const float tolerance : {1e-3f, 1e-5f, 1e-7f}) {
      const double sideways = 2 / kPi * (2.0 / 3) * std::sqrt(2 * static_cast<double>(tolerance));
      const Vec3d w = frame_area_weights(frame, with_tolerance(area, tolerance)) * determinant(frame);
      ASSERT_NEAR(w.x, sideways * length(frame.rows[0]), 0.01 * w.x) << tolerance;
      ASSERT_NEAR(w.y, sideways * length(frame.rows[1]), 0.01 * w.y) << tolerance;
      ASSERT_NEAR(w.z, dot(frame.rows[2], area.frame().forward), 1e-3 * frame.norm) << tolerance;
    }
  });
}

/// Rays from an area's near plane, each anywhere in its cone, drawn at random.
std::vector<Ray> drawn_rays(const AreaGeometry& area, size_t count, Random& random) {
  const auto& point = std::get<PointArea>(area.area().shape);
  const double least = 1 - static_cast<double>(area.area().tolerance);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Vec3d local{random.uniform(-1, 1) * area.window_half().x, random.uniform(-1, 1) * area.window_half().y, 1};
    const Vec3d axis = normalized(to_world_direction(area.frame(), local));
    const Vec3d v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (!(dot(v, v) <= 1) || !(dot(v, axis) >= least * length(v))) continue;
    rays.push_back({to_float(to_world(area.frame(), local * static_cast<double>(point.near_z))), to_float(v)});
  }
  return rays;
}

TEST(FrameWeights, OfPointAreasAreTheOffsetsOfTheirRays) {
  Random random(3);
  for (const float fov : {20.0f, 60.0f, 90.0f}) {
    const InfluenceArea lamp{"lamp", PointArea{{0.1f, 0.2f, -0.1f}, {1, 2, -0.5f}, {0, 1, 0}, fov, fov, 0.5f, 10},
                             0.05f};
    const AreaGeometry area(lamp);
    const RayFrame frame = *area_frame(FrameKind::kProjective, area);
    const Vec3d w = frame_area_weights(frame, area);
    const Vec3d drawn = frame_slope_weights(frame, drawn_rays(area, 4000, random));
    EXPECT_NEAR(w.x, drawn.x, 0.05 * drawn.x) << fov;
    EXPECT_NEAR(w.y, drawn.y, 0.05 * drawn.y) << fov;
    EXPECT_EQ(w.z, 1);
  }
}

TEST(FrameWeights, AreFiniteForEveryTolerance) {
  for_frames(60, [&](const RayFrame& frame, const AreaGeometry& area, Random& random) {
    const Vec3d w = frame_area_weights(frame, with_tolerance(area, random.below(2) ? kAll : 1e-20f));
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(std::isfinite(w[k]) && w[k] >= 0) << w[k];
    ASSERT_GT(w.z, 0);
  });
}

TEST(FrameWeights, NeedAFrameOfTheirKind) {
  Random random(1);
  const AreaGeometry sun(test::random_area(random, true)), lamp(test::random_area(random, false));
  const RayFrame turned = *area_frame(FrameKind::kRotation, sun), seen = *area_frame(FrameKind::kProjective, lamp);
  EXPECT_THROW(frame_face_weights(seen, std::vector{Vec3{0, 0, 1}}), Error);
  EXPECT_THROW(frame_face_weights(turned, {}), Error);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Vec3 bad : {Vec3{}, Vec3{0, nan, 1}, Vec3{kInf, 0, 0}})
    EXPECT_THROW(frame_face_weights(turned, std::vector{Vec3{0, 0, 1}, bad}), Error);
  EXPECT_THROW(frame_area_weights(seen, sun), Error);
  EXPECT_THROW(frame_area_weights(turned, lamp), Error);
}

TEST(FrameWeights, SlopesOfRaysAtAPointAreTheirOffsets) {
  for_frames(40, [&](const RayFrame& frame, const AreaGeometry& area, Random& random) {
    if (!frame.is_projective()) return;
    std::vector<Ray> exact, offset;
    const double shift = 0.01 * frame.near_z;
    for (int i = 0; i < 50; ++i) {
      const Vec3d from = test::point_inside(area.region(), random);
      const Vec3d to = frame.center + frame.rows[0] * shift;
      exact.push_back({to_float(from), to_float(frame.center - from)});
      offset.push_back({to_float(from), to_float(to - from)});
    }
    EXPECT_LT(frame_slope_weights(frame, exact).x, 1e-5 * test::diameter(area.region()));
    EXPECT_NEAR(frame_slope_weights(frame, offset).x, shift, 1e-5 * test::diameter(area.region()));
    EXPECT_EQ(frame_slope_weights(frame, {}), (Vec3d{0, 0, 1}));
  });
}

}  // namespace
}  // namespace raygrain

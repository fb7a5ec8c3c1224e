// Solid angles of polygons of the projection, beside formulas that are exact for rectangles and for tiny polygons.
#include "geometry/solid_angle.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/error.h"

#include "base/random.h"
#include "base/trigonometry.h"

namespace raygrain {
namespace {

/// Of the rectangle between the axes and (x, y), by the library's arctangent.
double corner_angle(double x, double y) {
  return std::atan(x * y / std::sqrt(1 + x * x + y * y));
}

double angle_of(Vec2d lo, Vec2d hi) {
  return solid_angle(std::array<Vec2d, 4>{{{lo.x, lo.y}, {hi.x, lo.y}, {hi.x, hi.y}, {lo.x, hi.y}}});
}

TEST(SolidAngle, OfRectanglesIsTheSumOfTheirCorners) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double reach = std::pow(10.0, random.uniform(-2, 2));
    const Vec2d lo{random.uniform(-reach, reach), random.uniform(-reach, reach)};
    const Vec2d hi{random.uniform(lo.x, reach), random.uniform(lo.y, reach)};
    const double expected =
        corner_angle(hi.x, hi.y) - corner_angle(lo.x, hi.y) - corner_angle(hi.x, lo.y) + corner_angle(lo.x, lo.y);
    const double far_x = std::max(-lo.x, std::abs(hi.x)), far_y = std::max(-lo.y, std::abs(hi.y));
    const double error = 2e-15 * (1 + far_x * far_x + far_y * far_y) * expected;
    ASSERT_NEAR(angle_of(lo, hi), expected, 4e-15 + error) << lo.x << ' ' << lo.y << ' ' << hi.x << ' ' << hi.y;
  }
  EXPECT_NEAR(rectangle_solid_angle({1, 1}), 4 * kPi / 6, 1e-15);
  EXPECT_NEAR(rectangle_solid_angle({3, 0.5}), 4 * corner_angle(3, 0.5), 1e-15);
}

// However small: the area times the density in the middle, up to the square of the size.
TEST(SolidAngle, OfTinyPolygonsKeepsItsDigits) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const double reach = std::pow(10.0, random.uniform(-1, 1.5)), size = std::pow(10.0, random.uniform(-12, -8));
    const Vec2d middle{random.uniform(-reach, reach), random.uniform(-reach, reach)};
    std::vector<Vec2d> points;
    const size_t corners = 3 + random.below(5);
    for (size_t k = 0; k < corners; ++k) {
      const double turn = 2 * kPi * static_cast<double>(k) / static_cast<double>(corners);
      points.push_back({middle.x + size * std::cos(turn), middle.y + size * std::sin(turn)});
    }
    ConvexPolygon polygon;
    for (const Vec2d p : points) polygon.push(p);
    const double square = 1 + middle.x * middle.x + middle.y * middle.y;
    const double expected = polygon_area(polygon) / (square * std::sqrt(square));
    ASSERT_NEAR(solid_angle(points), expected, (2e-15 * square + 4 * size) * expected) << middle.x << ' ' << middle.y;
  }
}

TEST(SolidAngle, AddsUpWherePolygonsAreCut) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec2d lo{random.uniform(-3, 0), random.uniform(-3, 0)}, hi{random.uniform(0, 3), random.uniform(0, 3)};
    const std::array<Vec2d, 3> below{{{lo.x, lo.y}, {hi.x, lo.y}, {hi.x, hi.y}}},
        above{{{lo.x, lo.y}, {hi.x, hi.y}, {lo.x, hi.y}}};
    const double whole = angle_of(lo, hi);
    ASSERT_NEAR(solid_angle(below) + solid_angle(above), whole, 1e-14 * whole);
  }
}

TEST(SolidAngle, TakesBothTurnsAndWhatHasNoArea) {
  const std::array<Vec2d, 3> left{{{0, 0}, {1, 0}, {0, 1}}}, right{{{0, 0}, {0, 1}, {1, 0}}};
  EXPECT_EQ(solid_angle(left), solid_angle(right));
  EXPECT_EQ(solid_angle({}), 0);
  EXPECT_EQ(solid_angle(std::span(left).first(2)), 0);
  EXPECT_EQ(solid_angle(std::array<Vec2d, 3>{{{0, 0}, {1, 1}, {2, 2}}}), 0);
}

TEST(SolidAngle, OfNearlyHalfOfTheSphere) {
  for (const double reach : {1e2, 1e4, 1e6})
    EXPECT_NEAR(angle_of({-reach, -reach}, {reach, reach}), rectangle_solid_angle({reach, reach}), 1e-14 * reach);
}

/// Along the axes, from the origin.
AreaGeometry lamp(float near_z, float degrees = 90) {
  return AreaGeometry({"lamp", PointArea{{}, {0, 0, 1}, {0, 1, 0}, degrees, degrees, near_z, 1e30f}});
}

double unculled(const AreaGeometry& area, Vec3 half) {
  return area.solid_angle({-half, half}, Culling::kNone);
}

// Outlines of boxes about the eye are half / near_z large: 1e38 and more. Only the flattest rays are left out.
TEST(SolidAngle, OfWhatReachesFar) {
  for (const float near_z : {1e-6f, 1e-3f, 0.1f, 10.0f}) {
    double last = 0;
    for (float half = near_z; half < 2e38f; half *= 7) {
      const double reach = static_cast<double>(half) / static_cast<double>(near_z);
      const double angle = unculled(lamp(near_z), {half, half, half});
      ASSERT_NEAR(angle, rectangle_solid_angle({reach, reach}), 9e-5) << near_z << ' ' << half;
      ASSERT_GE(angle, last * (1 - 1e-9)) << near_z << ' ' << half;
      last = angle;
    }
  }
  EXPECT_NEAR(unculled(lamp(0.01f), {1e6f, 1e-4f, 1}), rectangle_solid_angle({1e8, 0.01}), 0.04 * 2e-5);
  EXPECT_NEAR(unculled(lamp(1), {1e9f, 1e-3f, 1}), 0.004, 0.004 * 2e-5);
  EXPECT_EQ(unculled(lamp(1), {1e5f, 1e5f, 1}), unculled(lamp(1), {1e20f, 1e30f, 1e38f}));
  const Bounds flat{{7e4f, 0, 0.5f}, {8e4f, 1, 1}};  // seen, but farther out than what counts
  EXPECT_EQ(lamp(0.1f).solid_angle(flat, Culling::kNone), 0);
}

// A window that reaches farther bounds the outline instead.
TEST(SolidAngle, WithoutCullingIsNeverLess) {
  Random random(4);
  const float widest = std::nextafter(180.0f, 0.0f);
  for (const AreaGeometry& area : {lamp(0.1f), lamp(0.1f, 179.99f), lamp(1e-3f, widest)}) {
    ASSERT_EQ(unculled(area, {1e30f, 1e30f, 1e30f}) > area.window_solid_angle(), area.window_half().x < 0x1p16);
    for (int i = 0; i < 2000; ++i) {
      Bounds box;
      for (int k = 0; k < 2; ++k) {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
          p[axis] = static_cast<float>(random.uniform(-1, 1) * std::pow(10.0, random.uniform(-2, 1.5)));
        box.extend(p);
      }
      ASSERT_GE(area.solid_angle(box, Culling::kNone), area.solid_angle(box, Culling::kWindow) * (1 - 1e-9));
    }
  }
}

TEST(SolidAngle, ParallelRaysHaveNoEye) {
  const AreaGeometry sun({"sun", PlaneArea{}});
  EXPECT_THROW((void)sun.solid_angle({{0, 0, 0}, {1, 1, 1}}, Culling::kNone), Error);
  EXPECT_THROW((void)sun.window_solid_angle(), Error);
}

}  // namespace
}  // namespace raygrain

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

TEST(SolidAngle, ParallelRaysHaveNoEye) {
  const AreaGeometry sun({"sun", PlaneArea{}});
  EXPECT_THROW((void)sun.solid_angle({{0, 0, 0}, {1, 1, 1}}, Culling::kNone), Error);
  EXPECT_THROW((void)sun.window_solid_angle(), Error);
}

}  // namespace
}  // namespace raygrain

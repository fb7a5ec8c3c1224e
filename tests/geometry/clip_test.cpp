#include "geometry/clip.h"

#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/trigonometry.h"

namespace raygrain {
namespace {

ConvexPolygon polygon(std::initializer_list<Vec2d> points) {
  ConvexPolygon result;
  for (const Vec2d p : points) result.push(p);
  return result;
}

const ConvexPolygon kSquare = polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});

bool inside(const ConvexPolygon& p, Vec2d x) {
  for (size_t i = 0; i < p.count; ++i) {
    const Vec2d a = p.points[i], b = p.points[(i + 1) % p.count];
    if ((b.x - a.x) * (x.y - a.y) - (b.y - a.y) * (x.x - a.x) < 0) return false;
  }
  return true;
}

// Up to `corners` points of an ellipse: convex by construction.
ConvexPolygon random_polygon(Random& random, size_t corners) {
  std::array<Vec2d, 16> points;
  const Vec2d middle{random.uniform(-1, 1), random.uniform(-1, 1)};
  const double wide = random.uniform(0.1, 2), high = random.uniform(0.1, 2);
  for (size_t i = 0; i < corners; ++i) {
    const SineCosine angle = sine_cosine(random.uniform(0, 2 * kPi));
    points[i] = {middle.x + wide * angle.cosine, middle.y + high * angle.sine};
  }
  return convex_hull({points.data(), corners});
}

TEST(Clip, AreaOfKnownPolygons) {
  EXPECT_EQ(polygon_area(kSquare), 1);
  EXPECT_EQ(polygon_area(polygon({{5, 5}, {7, 5}, {5, 8}})), 3);
  EXPECT_EQ(polygon_area(polygon({{5, 5}, {7, 5}})), 0);
  EXPECT_EQ(polygon_area({}), 0);
  EXPECT_EQ(polygon_area(polygon({{0, 0}, {1, 1}, {2, 2}})), 0);
}

TEST(Clip, HullDropsInnerCollinearAndRepeatedPoints) {
  std::array<Vec2d, 8> points{{{0, 0}, {2, 0}, {1, 0}, {1, 1}, {2, 2}, {0, 2}, {2, 2}, {0, 1}}};
  const ConvexPolygon hull = convex_hull(points);
  EXPECT_EQ(hull.count, 4u);
  EXPECT_EQ(polygon_area(hull), 4);
  std::array<Vec2d, 3> line{{{0, 0}, {1, 1}, {2, 2}}};
  EXPECT_EQ(convex_hull(line).count, 2u);
  std::array<Vec2d, 3> point{{{1, 2}, {1, 2}, {1, 2}}};
  EXPECT_EQ(convex_hull(point).count, 1u);
  EXPECT_EQ(convex_hull({}).count, 0u);
}

TEST(Clip, SamePolygonIsItself) {
  EXPECT_EQ(polygon_area(intersect_convex(kSquare, kSquare)), 1);
  EXPECT_EQ(intersect_convex(kSquare, kSquare).count, 4u);
}

TEST(Clip, ContainedPolygonIsTheInnerOne) {
  const ConvexPolygon inner = polygon({{0.25, 0.25}, {0.75, 0.25}, {0.5, 0.75}});
  EXPECT_EQ(polygon_area(intersect_convex(kSquare, inner)), polygon_area(inner));
  EXPECT_EQ(polygon_area(intersect_convex(inner, kSquare)), polygon_area(inner));
}

TEST(Clip, TouchingPolygonsShareNoArea) {
  const ConvexPolygon right = polygon({{1, 0}, {2, 0}, {2, 1}, {1, 1}});
  EXPECT_EQ(polygon_area(intersect_convex(kSquare, right)), 0);
  EXPECT_GE(intersect_convex(kSquare, right).count, 2u);  // their common edge
  const ConvexPolygon diagonal = polygon({{1, 1}, {2, 1}, {2, 2}, {1, 2}});
  EXPECT_EQ(polygon_area(intersect_convex(kSquare, diagonal)), 0);
  const ConvexPolygon away = polygon({{1.5, 0}, {2, 0}, {2, 1}, {1.5, 1}});
  EXPECT_EQ(intersect_convex(kSquare, away).count, 0u);
}

TEST(Clip, DegeneratePolygonsGiveTheirPart) {
  const ConvexPolygon segment = polygon({{0.5, 0.5}, {3, 0.5}}), point = polygon({{0.5, 0.5}}),
                      outside = polygon({{3, 3}}), flat = polygon({{0.5, 0.5}, {1.5, 0.5}, {3, 0.5}});
  for (const ConvexPolygon& thin : {segment, flat}) {
    for (const ConvexPolygon& part : {intersect_convex(kSquare, thin), intersect_convex(thin, kSquare)}) {
      EXPECT_EQ(polygon_area(part), 0);
      ASSERT_GE(part.count, 2u);
      for (const Vec2d p : part.span()) {
        EXPECT_EQ(p.y, 0.5);
        EXPECT_GE(p.x, 0.5);
        EXPECT_LE(p.x, 1);
      }
    }
  }
  EXPECT_GE(intersect_convex(kSquare, point).count, 1u);
  EXPECT_EQ(intersect_convex(point, kSquare).count, 1u);
  EXPECT_EQ(intersect_convex(kSquare, outside).count, 0u);
  EXPECT_EQ(intersect_convex(outside, kSquare).count, 0u);
  EXPECT_EQ(intersect_convex(kSquare, {}).count, 0u);
  EXPECT_EQ(intersect_convex({}, kSquare).count, 0u);
  const ConvexPolygon repeated = polygon({{0, 0}, {0, 0}, {1, 0}, {1, 1}, {1, 1}, {0, 1}});
  EXPECT_EQ(polygon_area(intersect_convex(kSquare, repeated)), 1);
}

// The common part holds exactly the points that both hold.
TEST(Clip, RandomPolygonsAgreeWithPointSampling) {
  for (uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const ConvexPolygon a = random_polygon(random, 3 + random.below(14)),
                        b = random_polygon(random, 3 + random.below(14));
    const ConvexPolygon both = intersect_convex(a, b), swapped = intersect_convex(b, a);
    EXPECT_NEAR(polygon_area(both), polygon_area(swapped), 1e-12);
    EXPECT_LE(both.count, a.count + b.count);
    for (int i = 0; i < 200; ++i) {
      const Vec2d p{random.uniform(-3, 3), random.uniform(-3, 3)};
      EXPECT_EQ(inside(a, p) && inside(b, p), both.count > 0 && inside(both, p));
    }
    const Vec2d half{random.uniform(0.1, 2), random.uniform(0.1, 2)};
    const ConvexPolygon window = polygon({{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}});
    EXPECT_NEAR(polygon_area(clip_to_window(a, half)), polygon_area(intersect_convex(a, window)), 1e-12);
  }
}

TEST(Clip, PolygonAroundTheWindowIsTheWindowExactly) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Vec2d half{random.uniform(0.01, 1), random.uniform(0.01, 1)};
    const ConvexPolygon around = polygon({{-4, -5}, {5, -4.5}, {4, 6}, {-7, 5}});
    EXPECT_EQ(polygon_area(clip_to_window(around, half)), 4 * half.x * half.y);
  }
}

TEST(Clip, NearlyEqualPolygonsNeverOverflow) {
  for (uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const ConvexPolygon a = random_polygon(random, 16);
    ConvexPolygon b = a;
    for (size_t i = 0; i < b.count; ++i) {
      b.points[i].x += 1e-15 * random.uniform(-1, 1);
      b.points[i].y += 1e-15 * random.uniform(-1, 1);
    }
    EXPECT_NEAR(polygon_area(intersect_convex(a, b)), polygon_area(a), 1e-12);
  }
}

}  // namespace
}  // namespace raygrain

#include <set>

#include <gtest/gtest.h>

#include "raygrain/area.h"

#include "geometry/area_support.h"
#include "geometry/clip.h"

namespace raygrain {
namespace {

using test::random_vector;

ConvexPolygon project(const Frame& frame, const Bounds& box, std::span<const int> corners) {
  ConvexPolygon polygon;
  for (const int i : corners) {
    const Vec3d p = to_local(frame, to_double(corner(box, i)));
    polygon.push({p.x, p.y});
  }
  return polygon;
}

double signed_area(const ConvexPolygon& polygon) {
  double twice = 0;
  for (size_t i = 0; i < polygon.count; ++i) {
    const Vec2d p = polygon.points[i], q = polygon.points[(i + 1) % polygon.count];
    twice += p.x * q.y - p.y * q.x;
  }
  return twice / 2;
}

TEST(Silhouette, TwentySixSetsHaveOutlines) {
  std::set<std::vector<int>> outlines;
  for (unsigned faces = 0; faces < 64; ++faces) {
    const std::span<const int> corners = contour_corners(faces);
    const bool possible = faces != 0 && (faces & 3) != 3 && (faces & 12) != 12 && (faces & 48) != 48;
    const int count = __builtin_popcount(faces);
    EXPECT_EQ(corners.size(), possible ? (count == 1 ? 4u : 6u) : 0u) << faces;
    if (possible) outlines.insert({corners.begin(), corners.end()});
  }
  EXPECT_EQ(outlines.size(), 26u);
  EXPECT_TRUE(contour_corners(1000).empty());
}

TEST(Silhouette, FacesFollowTheTravelDirection) {
  EXPECT_EQ(visible_faces_along({1, 0, 0}), 1u);  // towards +x sees the face x = lo
  EXPECT_EQ(visible_faces_along({-1, 0, 0}), 2u);
  EXPECT_EQ(visible_faces_along({0, 1, -1}), 4u | 32u);
  const Bounds box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(visible_faces_from({-1, 0.5, 0.5}, box), 1u);
  EXPECT_EQ(visible_faces_from({2, -3, 4}, box), 2u | 4u | 32u);
  EXPECT_EQ(visible_faces_from({0.5, 0.5, 0.5}, box), 0u);
  EXPECT_EQ(visible_faces_from({1, 1, 1}, box), 0u);  // the closed box
}

// All sign combinations: 27 directions with components -1, 0, 1.
TEST(Silhouette, OutlineIsTheHullOfAllCorners) {
  const Bounds box{{-1, 2, 0.5f}, {1, 3, 4}};
  for (int code = 0; code < 27; ++code) {
    const Vec3d direction{static_cast<double>(code % 3 - 1), static_cast<double>(code / 3 % 3 - 1) * 0.7,
                          static_cast<double>(code / 9 - 1) * 1.3};
    if (direction == Vec3d{}) continue;
    SCOPED_TRACE(testing::Message() << "code " << code);
    const Frame frame = make_frame({}, direction, {0.1, 1, 0.2});
    const ConvexPolygon outline = project(frame, box, contour_corners(visible_faces_along(direction)));
    std::array<Vec2d, 8> all;
    for (int i = 0; i < 8; ++i) {
      const Vec3d p = to_local(frame, to_double(corner(box, i)));
      all[static_cast<size_t>(i)] = {p.x, p.y};
    }
    EXPECT_GT(signed_area(outline), 0);  // counterclockwise
    EXPECT_NEAR(signed_area(outline), polygon_area(convex_hull(all)), 1e-12);
  }
}

TEST(Silhouette, OutlineFromAPointIsTheHullOfAllCorners) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Bounds box{{-1, -1, -1}, {1, 2, 0.5f}};
    const Vec3d eye = random_vector(random) * 6.0;
    const unsigned faces = visible_faces_from(eye, box);
    if (faces == 0) continue;
    // Look from the eye at the box's middle; project the corners that are before the eye's plane.
    const Frame frame = make_frame(eye, to_double(center(box)) - eye, {0, 1, 0});
    std::array<Vec2d, 8> all;
    bool in_front = true;
    for (int i = 0; i < 8; ++i) {
      const Vec3d p = to_local(frame, to_double(corner(box, i)));
      in_front = in_front && p.z > 0.01;
      all[static_cast<size_t>(i)] = {p.x / p.z, p.y / p.z};
    }
    if (!in_front) continue;
    ConvexPolygon outline;
    for (const int i : contour_corners(faces)) outline.push(all[static_cast<size_t>(i)]);
    std::array<Vec2d, 8> sorted = all;
    const double hull = polygon_area(convex_hull(sorted));
    EXPECT_NEAR(signed_area(outline), hull, 1e-12 * hull);
  }
}

}  // namespace
}  // namespace raygrain

#include "raygrain/frame.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"

namespace raygrain {
namespace {

void expect_orthonormal(const Frame& f) {
  EXPECT_NEAR(length(f.right), 1, 1e-15);
  EXPECT_NEAR(length(f.up), 1, 1e-15);
  EXPECT_NEAR(length(f.forward), 1, 1e-15);
  EXPECT_NEAR(dot(f.right, f.up), 0, 1e-15);
  EXPECT_NEAR(dot(f.up, f.forward), 0, 1e-15);
  EXPECT_NEAR(dot(f.forward, f.right), 0, 1e-15);
  EXPECT_NEAR(dot(cross(f.right, f.up), f.forward), 1, 1e-15);
}

TEST(Frame, RandomFramesAreOrthonormalAndKeepForwardAndUp) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const auto vector = [&] {
      return Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)} *
             std::pow(10.0, random.uniform(-44, 38));
    };
    const Vec3d forward = vector(), up = vector();
    const Frame frame = make_frame({}, forward, up);
    expect_orthonormal(frame);
    EXPECT_NEAR(dot(frame.forward, forward) / length(forward), 1, 1e-15);
    EXPECT_GE(dot(frame.up, up), 0);
    EXPECT_NEAR(dot(frame.right, up) / length(up), 0, 1e-9);
  }
}

TEST(Frame, VerticalDirectionsWork) {
  for (const Vec3d forward : {Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{0, 5e30, 0}, Vec3d{1e-8, -1, 0}}) {
    const Frame frame = make_frame({}, forward, {0, 1, 0});
    expect_orthonormal(frame);
    EXPECT_NEAR(dot(frame.forward, forward) / length(forward), 1, 1e-15);
  }
}

TEST(Frame, ZeroUpIsReplaced) {
  expect_orthonormal(make_frame({}, {1, 2, 3}, {}));
}

TEST(Frame, LooksAlongZByDefault) {
  const Frame frame = make_frame({1, 2, 3}, {0, 0, 2}, {0, 1, 0});
  EXPECT_EQ(frame.right, (Vec3d{1, 0, 0}));
  EXPECT_EQ(frame.up, (Vec3d{0, 1, 0}));
  EXPECT_EQ(frame.forward, (Vec3d{0, 0, 1}));
  EXPECT_EQ(to_local(frame, {2, 4, 6}), (Vec3d{1, 2, 3}));
}

TEST(Frame, LocalAndWorldAreInverse) {
  const Frame frame = make_frame({1, 2, 3}, {1, -2, 0.5}, {0, 1, 0});
  const Vec3d point{4, -5, 6}, back = to_world(frame, to_local(frame, point));
  EXPECT_NEAR(length(back - point), 0, 1e-14);
}

}  // namespace
}  // namespace raygrain

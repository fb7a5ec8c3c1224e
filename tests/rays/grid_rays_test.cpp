#include <cmath>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/rays.h"

namespace raygrain {
namespace {

Vec3d through_pixel(const CameraRays& camera, uint32_t column, uint32_t row) {
  return to_double(cast_rays(camera)[row * camera.width + column].direction);
}

// Looking along -z with y up, x is on the right: the first pixel is up and to the left.
TEST(CameraRays, StartAtTheTopLeftAndAreNotMirrored) {
  const CameraRays camera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90, 4, 2};
  const std::vector<Ray> rays = cast_rays(camera);
  ASSERT_EQ(rays.size(), 8u);
  // At distance 1 the picture is 4 wide and 2 high; the pixels' middles are at x = -1.5, -0.5, ..., y = 0.5, -0.5.
  for (uint32_t row = 0; row < 2; ++row)
    for (uint32_t column = 0; column < 4; ++column) {
      const Vec3d d = through_pixel(camera, column, row);
      EXPECT_NEAR(d.x / -d.z, -1.5 + column, 1e-6);
      EXPECT_NEAR(d.y / -d.z, 0.5 - row, 1e-6);
      EXPECT_NEAR(length(d), 1, 1e-6);
    }
  for (const Ray& ray : rays) {
    EXPECT_EQ(ray.origin, camera.eye);
    EXPECT_EQ(ray.tmin, 0);
    EXPECT_EQ(ray.tmax, kInf);
  }
}

TEST(CameraRays, LookStraightDown) {
  CameraRays camera{{3, 9, 1}, {3, 0, 1}};
  camera.width = camera.height = 1;
  const std::vector<Ray> rays = cast_rays(camera);
  ASSERT_EQ(rays.size(), 1u);
  EXPECT_NEAR(rays[0].direction.y, -1, 1e-6);
}

TEST(CameraRays, RefuseOptionsOutOfRange) {
  const CameraRays good{{0, 0, 5}, {0, 0, 0}};
  std::vector<CameraRays> table(8, good);
  table[0].target = good.eye;
  table[1].fov_y = 0;
  table[2].fov_y = 180;
  table[3].fov_y = NAN;
  table[4].width = 0;
  table[5].height = 0;
  table[6].eye.x = NAN;
  table[7].width = table[7].height = 1u << 20;
  EXPECT_NO_THROW(cast_rays(good));
  for (size_t i = 0; i < table.size(); ++i) {
    SCOPED_TRACE(i);
    try {
      cast_rays(table[i]);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kUsage);
    }
  }
}

// A viewer at the sun, looking straight along -z: x to the right, y up.
TEST(WindowGridRays, AreAPictureSeenFromThePlane) {
  const InfluenceArea area{"sun", PlaneArea{{0, 0, 9}, {0, 0, -1}, {0, 1, 0}, 4, 2, 20}};
  const std::vector<Ray> rays = window_grid_rays(area, 4, 2);
  ASSERT_EQ(rays.size(), 8u);
  for (uint32_t row = 0; row < 2; ++row)
    for (uint32_t column = 0; column < 4; ++column) {
      const Ray& ray = rays[row * 4 + column];
      EXPECT_NEAR(ray.origin.x, -3 + 2.0 * column, 1e-6);
      EXPECT_NEAR(ray.origin.y, 1 - 2.0 * row, 1e-6);
      EXPECT_NEAR(ray.origin.z, 9, 1e-6);
      EXPECT_EQ(ray.direction, (Vec3{0, 0, -1}));
    }
}

TEST(WindowGridRays, AreAPictureSeenFromThePoint) {
  const InfluenceArea area{"lamp", PointArea{{1, 2, 3}, {0, 0, -1}, {0, 1, 0}, 90, 90, 0.5f, 20}};
  const std::vector<Ray> rays = window_grid_rays(area, 2, 2);
  ASSERT_EQ(rays.size(), 4u);
  const Vec3d expected[] = {{-0.5, 0.5, -1}, {0.5, 0.5, -1}, {-0.5, -0.5, -1}, {0.5, -0.5, -1}};
  for (size_t i = 0; i < rays.size(); ++i) {
    const Vec3d d = to_double(rays[i].direction), out = to_double(rays[i].origin) - Vec3d{1, 2, 3};
    EXPECT_NEAR(length(d - normalized(expected[i])), 0, 1e-6);
    EXPECT_NEAR(length(out - expected[i] * 0.5), 0, 1e-6);
  }
}

TEST(WindowGridRays, AreAllServed) {
  const InfluenceArea areas[] = {
      {"plane", PlaneArea{{3, 40, -7}, {0.35f, -0.8f, 0.48f}, {0, 1, 0}, 12, 5, 60}},
      {"point", PointArea{{-4, 9, 2}, {0.6f, -0.5f, 0.3f}, {0, 1, 0}, 90, 60, 0.5f, 80}},
  };
  for (const InfluenceArea& area : areas) {
    SCOPED_TRACE(area.name);
    const AreaGeometry geometry(area);
    for (const Ray& ray : window_grid_rays(area, 50, 30)) ASSERT_TRUE(geometry.serves(ray));
  }
}

TEST(WindowGridRays, RefuseEmptyPicturesAndBadAreas) {
  const InfluenceArea good{"sun", PlaneArea{}};
  InfluenceArea bad = good;
  std::get<PlaneArea>(bad.shape).depth = -1;
  EXPECT_THROW(window_grid_rays(good, 0, 5), Error);
  EXPECT_THROW(window_grid_rays(good, 5, 0), Error);
  EXPECT_THROW(window_grid_rays(bad, 5, 5), Error);
}

}  // namespace
}  // namespace raygrain

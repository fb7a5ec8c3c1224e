#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/rays.h"

#include "rays/statistics.h"

namespace raygrain {
namespace {

using test::bin;
using test::chi_square_deviation;

constexpr size_t kCount = 20000;

// A unit square in y = 0 of two triangles, a triangle without area, and a triangle of area 1 in x = 5, facing -x.
TriangleMesh square_and_wall() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {5, 0, 0}, {5, 0, 2}, {5, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 1}, {0, 2, 3}, {4, 6, 5}};
  return mesh;
}

double offset_of(const TriangleMesh& mesh) {
  const Bounds box = mesh_bounds(mesh);
  return 1e-4 * length(to_double(box.hi) - to_double(box.lo));
}

TEST(SurfaceRays, StartUniformlyByArea) {
  const TriangleMesh mesh = square_and_wall();
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    std::vector<size_t> square(100), wall(100);
    size_t on_square = 0;
    for (const Ray& ray : cast_rays(SurfaceRays{TowardsDirection{{0, -1, 0}}}, mesh, kCount, seed)) {
      const Vec3d p = to_double(ray.origin);
      if (p.x < 2) {
        ++on_square;
        ++square[bin(p.x, 10) * 10 + bin(p.z, 10)];
      } else {
        // (z, y) of a triangle with corners (0, 0), (2, 0), (0, 1): rows by area, then position along the row.
        const double above = 1 - p.y;
        ++wall[bin(above * above, 10) * 10 + bin(p.z / (2 * above), 10)];
      }
    }
    EXPECT_NEAR(static_cast<double>(on_square), kCount / 2.0, 5 * std::sqrt(kCount / 4.0));
    EXPECT_LT(std::abs(chi_square_deviation(square)), 4.5);
    EXPECT_LT(std::abs(chi_square_deviation(wall)), 4.5);
  }
}

TEST(SurfaceRays, LeaveOnTheSideThatFacesTheTarget) {
  const TriangleMesh mesh = square_and_wall();
  const double offset = offset_of(mesh);
  const struct {
    SurfaceRays rays;
    double square_side, wall_side;  // of y and of x
  } table[] = {
      {{TowardsDirection{{-0.3f, -1, 0.2f}}}, 1, 1},
      {{TowardsDirection{{0.3f, 1, 0.2f}}}, -1, -1},
      {{TowardsPoint{{2, 7, 0}}}, 1, -1},
      {{TowardsPoint{{9, -7, 0}}}, -1, 1},
      {{TowardsRectangle{{2, 7, 0}, {1, 0, 0}, {0, 0, 1}}}, 1, -1},
  };
  for (const auto& row : table)
    for (const Ray& ray : cast_rays(row.rays, mesh, 1000, 3)) {
      if (ray.origin.x < 2)
        ASSERT_NEAR(ray.origin.y, row.square_side * offset, 1e-6);
      else
        ASSERT_NEAR(ray.origin.x, 5 + row.wall_side * offset, 1e-6);
    }
}

TEST(SurfaceRays, TowardsADirectionRunAgainstTheLight) {
  const Vec3 light{0.35f, -0.8f, 0.48f};
  const Vec3 expected = to_float(-normalized(to_double(light)));
  for (const Ray& ray : cast_rays(SurfaceRays{TowardsDirection{light}}, square_and_wall(), 100, 1)) {
    EXPECT_EQ(ray.direction, expected);
    EXPECT_EQ(ray.tmin, 0);
    EXPECT_EQ(ray.tmax, kInf);
  }
}

TEST(SurfaceRays, TowardsAPointEndThere) {
  const Vec3 light{2.1f, 7.3f, -0.7f};
  for (const Ray& ray : cast_rays(SurfaceRays{TowardsPoint{light}}, square_and_wall(), 1000, 1)) {
    ASSERT_EQ(ray.direction, light - ray.origin);
    ASSERT_EQ(ray.tmin, 0);
    ASSERT_EQ(ray.tmax, 1);
  }
}

TEST(SurfaceRays, TowardsARectangleEndUniformlyOnIt) {
  const TowardsRectangle light{{2, 7, 1}, {1.5f, 0, 0.5f}, {0, 0.5f, 1}};
  const Vec3d u = to_double(light.half_u), v = to_double(light.half_v), n = cross(u, v);
  std::vector<size_t> counts(256);
  for (const Ray& ray : cast_rays(SurfaceRays{light}, square_and_wall(), kCount, 7)) {
    ASSERT_EQ(ray.tmax, 1);
    const Vec3d d = to_double(ray.origin) + to_double(ray.direction) - to_double(light.center);
    ASSERT_NEAR(dot(d, n), 0, 1e-5);
    const double along_u = dot(d, cross(v, n)) / dot(u, cross(v, n)),
                 along_v = dot(d, cross(u, n)) / dot(v, cross(u, n));
    ASSERT_LE(std::max(std::abs(along_u), std::abs(along_v)), 1 + 1e-5);
    ++counts[bin((along_u + 1) / 2, 16) * 16 + bin((along_v + 1) / 2, 16)];
  }
  EXPECT_LT(std::abs(chi_square_deviation(counts)), 4.5);
}

TEST(SurfaceRays, AreABeginningOfLongerSets) {
  const SurfaceRays options{TowardsRectangle{{2, 7, 1}, {1.5f, 0, 0.5f}, {0, 0.5f, 1}}};
  const TriangleMesh mesh = square_and_wall();
  const std::vector<Ray> many = cast_rays(options, mesh, 300, 8), few = cast_rays(options, mesh, 20, 8);
  for (size_t i = 0; i < few.size(); ++i) EXPECT_EQ(std::memcmp(&few[i], &many[i], sizeof(Ray)), 0);
  EXPECT_TRUE(cast_rays(options, mesh, 0, 8).empty());
}

TEST(SurfaceRays, NoneFromAMeshWithoutArea) {
  const SurfaceRays options{TowardsPoint{{0, 1, 0}}};
  EXPECT_TRUE(cast_rays(options, TriangleMesh{}, 10, 1).empty());
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 1, 1}};
  line.triangles = {{0, 0, 1}, {0, 1, 1}};
  EXPECT_TRUE(cast_rays(options, line, 10, 1).empty());
}

TEST(SurfaceRays, RefuseTargetsThatCannotBeMeant) {
  const SurfaceRays table[] = {
      {TowardsDirection{{0, 0, 0}}},
      {TowardsDirection{{NAN, 0, 1}}},
      {TowardsPoint{{0, kInf, 0}}},
      {TowardsRectangle{{0, 0, 0}, {kInf, 0, 0}, {0, 0, 1}}},
  };
  for (const SurfaceRays& options : table) {
    try {
      cast_rays(options, square_and_wall(), 10, 1);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kUsage);
    }
  }
}

}  // namespace
}  // namespace raygrain

// What structures over triangles refuse, rather than read beyond their input.
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/build.h"
#include "raygrain/coverage.h"
#include "raygrain/frame_tree.h"
#include "raygrain/wide.h"

#include "support/error_of.h"
#include "support/triangle_soup.h"

namespace raygrain::test {
namespace {

constexpr uint32_t kTriangles = 30;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

const RayFrame& frame() {
  static const RayFrame made = *parallel_frame(FrameKind::kRotation, {0.3f, -1, 0.2f}, {50, 50, 50});
  return made;
}

std::shared_ptr<const TriangleCorners> corners() {
  return std::make_shared<const TriangleCorners>(triangle_soup(kTriangles, 1));
}

Bvh tree_over_more(uint32_t more) {
  const TriangleMesh mesh = triangle_soup(kTriangles + more, 1);
  return build_binned(triangle_bounds(mesh), triangle_centroids(mesh), {});
}

TEST(Errors, TreesRefuseTrianglesThatAreNotThere) {
  const TriangleMesh mesh = triangle_soup(kTriangles, 1);
  EXPECT_NO_THROW(WideBvh(tree_over_more(0), mesh));
  EXPECT_NO_THROW(FrameTree(frame(), tree_over_more(0), corners()));
  const Error wide = error_of([&] { WideBvh(tree_over_more(1), mesh); });
  EXPECT_EQ(wide.code, ErrorCode::kUsage);
  EXPECT_EQ(wide.where, "WideBvh");
  EXPECT_NE(std::string(wide.what()).find("30 of 30 triangles"), std::string::npos) << wide.what();
  EXPECT_EQ(error_of([] { FrameTree(frame(), tree_over_more(1), corners()); }).where, "FrameTree");
  for (const uint32_t wrong : {kTriangles, 4000000000u}) {
    const std::vector<uint32_t> triangles{0, wrong, 1};
    const Error error = error_of([&] { build_frame_tree(frame(), corners(), triangles); });
    EXPECT_EQ(error.code, ErrorCode::kUsage);
    EXPECT_EQ(error.where, "build_frame_tree");
  }
}

TEST(Errors, TreesInRaySpaceRefuseBadOptions) {
  const std::vector<uint32_t> triangles{0, 1, 2};
  const auto build = [&](Vec3d weights, double z_term) {
    build_frame_tree(frame(), corners(), triangles, {.weights = weights, .z_term = static_cast<float>(z_term)});
  };
  EXPECT_NO_THROW(build({0, 0, 1}, 0));
  EXPECT_NO_THROW(build({2, 0.5, 3}, 0.1));
  for (const double bad : {kNan, kInfinity, -1.0}) {
    SCOPED_TRACE(bad);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d weights{0, 0, 1};
      weights[axis] = bad;
      EXPECT_EQ(error_of([&] { build(weights, 0.1); }).code, ErrorCode::kUsage);
    }
    EXPECT_EQ(error_of([&] { build({0, 0, 1}, bad); }).code, ErrorCode::kUsage);
  }
  EXPECT_EQ(error_of([&] { build({0, 0, 0}, 0.1); }).code, ErrorCode::kUsage);
  EXPECT_EQ(error_of([&] { build({1e300, 0, 1e-300}, 0.1); }).code, ErrorCode::kUsage);
  EXPECT_EQ(error_of([&] { build_frame_tree(frame(), nullptr, triangles); }).code, ErrorCode::kUsage);
}

/// Asks each of the four batch calls, with room for `answers`.
template <class Check>
void for_calls(const Coverage& coverage, Vec3 place, size_t answers, const std::vector<uint32_t>& subset,
               const Check& check) {
  const std::vector<Vec3> points(5, Vec3{50, 50, 50});
  std::vector<uint8_t> flags(answers);
  std::vector<Hit> hits(answers);
  std::vector<uint32_t> rest;
  check([&] { coverage.occluded(points, place, flags, rest, subset); });
  check([&] { coverage.occluded_towards(points, place, flags, rest, subset); });
  check([&] { coverage.intersect(points, place, hits, rest, subset); });
  check([&] { coverage.intersect_from(place, points, hits, rest, subset); });
}

TEST(Errors, CoverageRefusesRaysThatAreNotThere) {
  const auto mesh = std::make_shared<const TriangleMesh>(triangle_soup(kTriangles, 1));
  const Bounds box = mesh_bounds(*mesh);
  const Vec3 light{0.3f, -1, 0.2f}, eye{200, 60, 50};
  const Coverage sun(mesh, directional_light_area("sun", light, box));
  const Coverage camera(mesh, camera_area("camera", eye, center(box), 40, 1, box));
  const Coverage none;
  struct Case {
    const Coverage& coverage;
    Vec3 place;
  };
  for (const auto& [coverage, place] : {Case{sun, light}, Case{sun, -light}, Case{camera, eye}, Case{none, eye}}) {
    for_calls(coverage, place, 5, {0, 4}, [](const auto& call) { EXPECT_NO_THROW(call()); });
    const auto refuses = [](const auto& call) { EXPECT_EQ(error_of(call).code, ErrorCode::kUsage); };
    for_calls(coverage, place, 4, {}, refuses);
    for_calls(coverage, place, 5, {0, 5}, refuses);
    for_calls(coverage, place, 5, {4000000000u}, refuses);
  }
}

TEST(Errors, CoverageDividesAmongAFew) {
  const Coverage none;
  std::vector<uint32_t> rest;
  const auto divide = [&](size_t count) {
    Coverage::divide(std::vector<const Coverage*>(count, &none), std::vector<Vec3>(3), false, rest);
  };
  EXPECT_NO_THROW(divide(254));
  EXPECT_EQ(error_of([&] { divide(0); }).code, ErrorCode::kUsage);
  EXPECT_EQ(error_of([&] { divide(255); }).code, ErrorCode::kUsage);
}

}  // namespace
}  // namespace raygrain::test

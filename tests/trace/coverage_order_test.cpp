// The order in which a batch is answered changes neither its answers nor what is counted: columns that meet triangles
// together are told what each would be told alone. (Counts are those of one instruction set: whether products are fused
// with sums moves a few rays into and out of the margins.) Rays come in clusters, so that several are in each cell.
#include <algorithm>

#include <gtest/gtest.h>

#include "raygrain/coverage.h"

#include "base/random.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"

namespace raygrain {
namespace {

/// Rays that a coverage may answer: towards a light with any hit, and away from it with the first.
struct Questions {
  InfluenceArea area;
  bool is_eye = false;
  Vec3 light;  // its direction, or the eye
  std::vector<Vec3> points, directions;
};

struct Answered {
  std::vector<uint8_t> flags;
  std::vector<Hit> hits;
  std::vector<uint32_t> rest_of_any, rest_of_nearest;
  CoverageCounters any, nearest;
};

/// Points on the mesh, near it, and before it as the light comes: up to eight of them about each place, in no order.
std::vector<Vec3> clusters(const TriangleMesh& mesh, Vec3 light, size_t count, Random& random) {
  const Vec3 size = extent(mesh_bounds(mesh));
  const float reach = static_cast<float>(length(to_double(size)));
  std::vector<Vec3> points;
  while (points.size() < count) {
    const size_t t = random.below(mesh.triangle_count());
    const Vec3 corner = mesh.vertex(t, 0), along = mesh.vertex(t, 1) - corner;
    Vec3 place = corner + along * static_cast<float>(random.uniform());
    if (random.below(4) == 0) place = place + size * static_cast<float>(random.uniform(-1, 1));
    if (random.below(2) == 0) place = place - light * (2 * reach);
    for (uint64_t i = random.below(9); i-- > 0;) {
      const float step = random.below(2) == 0 ? 0.0f : 1e-6f * static_cast<float>(i);
      points.push_back(place + size * step);
    }
  }
  for (size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
  return points;
}

std::vector<Questions> questions_about(const TriangleMesh& mesh, Random& random) {
  constexpr size_t kRays = 3000;
  const Bounds box = mesh_bounds(mesh);
  const Vec3 light{0.3f, -0.8f, 0.45f};
  Questions sun{directional_light_area("sun", light, box), false, light, clusters(mesh, light, kRays, random), {}};
  const Vec3 eye = center(box) - light * (0.7f * static_cast<float>(length(to_double(extent(box)))));
  Questions camera{camera_area("camera", eye, center(box), 90, 1, box), true, eye, {}, {}};
  camera.points = clusters(mesh, {}, kRays, random);
  for (const Vec3 p : camera.points) camera.directions.push_back(p - eye);
  return {sun, camera};
}

/// All rays, or those of a subset.
Answered ask(const Coverage& coverage, const Questions& q, const std::vector<uint32_t>& subset, unsigned threads) {
  Answered a{std::vector<uint8_t>(q.points.size()), std::vector<Hit>(q.points.size()), {}, {}, {}, {}};
  if (q.is_eye) {
    coverage.occluded_towards(q.points, q.light, a.flags, a.rest_of_any, subset, threads, &a.any);
    coverage.intersect_from(q.light, q.directions, a.hits, a.rest_of_nearest, subset, threads, &a.nearest);
  } else {
    coverage.occluded(q.points, -q.light, a.flags, a.rest_of_any, subset, threads, &a.any);
    coverage.intersect(q.points, q.light, a.hits, a.rest_of_nearest, subset, threads, &a.nearest);
  }
  for (const uint32_t i : a.rest_of_any) a.flags[i] = 0;
  for (const uint32_t i : a.rest_of_nearest) a.hits[i] = {};
  return a;
}

void expect_same(const CoverageCounters& a, const CoverageCounters& b) {
  EXPECT_EQ(a.rays, b.rays);
  EXPECT_EQ(a.covered, b.covered);
  EXPECT_EQ(a.free, b.free);
  EXPECT_EQ(a.triangle_tests, b.triangle_tests);
  EXPECT_EQ(a.confirmations, b.confirmations);
}

void expect_same(const Answered& a, const Answered& b) {
  EXPECT_EQ(a.flags, b.flags);
  EXPECT_EQ(a.rest_of_any, b.rest_of_any);
  EXPECT_EQ(a.rest_of_nearest, b.rest_of_nearest);
  expect_same(a.any, b.any);
  expect_same(a.nearest, b.nearest);
  for (size_t i = 0; i < a.hits.size(); ++i) ASSERT_TRUE(test::same_bits(a.hits[i], b.hits[i])) << "ray " << i;
}

void compare_orders(const std::shared_ptr<const TriangleMesh>& mesh, const Questions& q, CoverageOptions options,
                    CoverageCounters& any, CoverageCounters& nearest) {
  std::vector<uint32_t> some;
  for (uint32_t i = 0; i < q.points.size(); i += 1 + i % 3) some.push_back(i);
  for (const Isa isa : supported_isas()) {
    options.isa = isa;
    options.order = CoverageOrder::kAsGiven;
    const Coverage as_given(mesh, q.area, options);
    const Answered all = ask(as_given, q, {}, 1), chosen = ask(as_given, q, some, 1);
    any.add(all.any), nearest.add(all.nearest);
    for (const CoverageOrder order : kCoverageOrders) {
      SCOPED_TRACE(q.area.name + ", " + std::string(name(isa)) + ", " + std::string(name(order)));
      options.order = order;
      const Coverage coverage(mesh, q.area, options);
      for (const unsigned threads : {1u, 2u}) expect_same(all, ask(coverage, q, {}, threads));
      expect_same(chosen, ask(coverage, q, some, 1));
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(CoverageOrder, ChangesNeitherAnswersNorCounts) {
  CoverageCounters any, nearest;
  for (uint64_t seed = 0; seed < test::seed_count(2); ++seed)
    for (const test::NamedMesh& family : test::mesh_families(seed)) {
      if (family.mesh.triangles.empty()) continue;
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      const auto mesh = std::make_shared<const TriangleMesh>(family.mesh);
      const Bounds box = mesh_bounds(*mesh);
      if (!(length(to_double(extent(box))) < 0x1p60 && length(to_double(box.lo)) < 0x1p60)) continue;
      Random random(seed + 5);
      const CoverageOptions options{seed % 2 == 0 ? 0.25f : 4.0f, 64, {}, CoverageOrder::kAsGiven, 1};
      for (const Questions& q : questions_about(*mesh, random)) compare_orders(mesh, q, options, any, nearest);
      if (HasFailure()) return;
    }
  EXPECT_GT(any.covered, any.rays / 50);
  EXPECT_GT(any.triangle_tests, any.rays / 2);
  EXPECT_GT(any.confirmations, any.rays / 100);
  EXPECT_GT(nearest.triangle_tests, nearest.rays / 2);
  EXPECT_GT(nearest.confirmations, nearest.rays / 5);
}

TEST(CoverageOrder, HasNames) {
  for (const CoverageOrder order : kCoverageOrders) EXPECT_FALSE(name(order).empty());
  EXPECT_EQ(name(CoverageOrder::kByCell), "by-cell");
}

}  // namespace
}  // namespace raygrain

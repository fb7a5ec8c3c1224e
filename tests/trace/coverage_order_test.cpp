// The order in which a batch is answered changes neither its answers nor what is counted: columns that meet triangles
// together are told what each would be told alone. (Counts are those of one instruction set: whether products are fused
// with sums moves a few rays into and out of the margins.) Rays come in clusters, so that several are in each cell.
#include <algorithm>

#include <gtest/gtest.h>

#include "raygrain/coverage.h"

#include "base/random.h"
#include "support/coverage_orders.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"

namespace raygrain {
namespace {

struct Answered {
  std::vector<uint8_t> flags;
  std::vector<Hit> hits;
  std::vector<uint32_t> rest_of_any, rest_of_nearest;
  CoverageCounters any, nearest;
};

/// Points on the mesh and near it, and where nothing is: up to nine of them about each place, in no order.
std::vector<Vec3> clusters(const TriangleMesh& mesh, size_t count, Random& random) {
  const Bounds box = mesh_bounds(mesh);
  const Vec3 size = extent(box);
  std::vector<Vec3> points;
  while (points.size() < count) {
    const size_t t = random.below(mesh.triangle_count());
    const Vec3 corner = mesh.vertex(t, 0), away = (mesh.vertex(t, 1) - corner) * static_cast<float>(random.uniform());
    Vec3 place = corner + away;
    if (random.below(3) == 0) place = place + size * static_cast<float>(random.uniform(-1, 1));
    for (uint64_t i = random.below(9); i-- > 0;) {
      const float step = random.below(2) == 0 ? 0.0f : 1e-6f * static_cast<float>(i);
      points.push_back(place + size * step);
    }
  }
  for (size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
  return points;
}

Answered ask(const Coverage& coverage, const std::vector<Vec3>& points, Vec3 light, unsigned threads) {
  Answered a{std::vector<uint8_t>(points.size()), std::vector<Hit>(points.size()), {}, {}, {}, {}};
  coverage.occluded(points, -light, a.flags, a.rest_of_any, {}, threads, &a.any);
  coverage.intersect(points, light, a.hits, a.rest_of_nearest, {}, threads, &a.nearest);
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

TEST(CoverageOrder, ChangesNeitherAnswersNorCounts) {
  const Vec3 light{0.3f, -0.8f, 0.45f};
  size_t useful = 0;
  CoverageCounters seen;
  for (uint64_t seed = 0; seed < test::seed_count(2); ++seed)
    for (const test::NamedMesh& family : test::mesh_families(seed)) {
      if (family.mesh.triangles.empty()) continue;
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      const auto mesh = std::make_shared<const TriangleMesh>(family.mesh);
      const Bounds box = mesh_bounds(*mesh);
      if (!(length(to_double(extent(box))) < 0x1p60 && length(to_double(box.lo)) < 0x1p60)) continue;
      Random random(seed + 5);
      const std::vector<Vec3> points = clusters(*mesh, 6000, random);
      CoverageOptions options{seed % 2 == 0 ? 0.25f : 4.0f, 64, {}, CoverageOrder::kAsGiven, 1};
      const InfluenceArea area = directional_light_area("sun", light, box);
      for (const Isa isa : supported_isas()) {
        options.isa = isa;
        options.order = CoverageOrder::kAsGiven;
        const Answered expected = ask(Coverage(mesh, area, options), points, light, 1);
        seen.add(expected.any), seen.add(expected.nearest);
        for (const CoverageOrder order : test::kCoverageOrders) {
          SCOPED_TRACE(std::string(name(isa)) + ", " + std::string(name(order)));
          options.order = order;
          const Coverage coverage(mesh, area, options);
          useful += coverage.is_useful();
          for (const unsigned threads : {1u, 2u}) expect_same(expected, ask(coverage, points, light, threads));
          if (HasFailure()) return;
        }
      }
    }
  EXPECT_GT(useful, 0u);
  EXPECT_GT(seen.covered, seen.rays / 100);
  EXPECT_GT(seen.triangle_tests, seen.rays / 2);
  EXPECT_GT(seen.confirmations, seen.rays / 100);
}

TEST(CoverageOrder, HasNames) {
  for (const CoverageOrder order : test::kCoverageOrders) EXPECT_FALSE(name(order).empty());
  EXPECT_EQ(name(CoverageOrder::kByCell), "by-cell");
}

}  // namespace
}  // namespace raygrain

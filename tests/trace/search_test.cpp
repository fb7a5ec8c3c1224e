// Every search over every tree against brute force, bit for bit.

#include <bit>

#include <gtest/gtest.h>

#include "raygrain/trace.h"
#include "raygrain/triangle.h"

#include "support/mesh_families.h"
#include "support/same_bits.h"
#include "trace/hand_made_trees.h"

namespace raygrain {
namespace {

using test::same_bits;

using test::NamedMesh;
using test::NamedTree;

template <class Body>
void for_families(uint64_t seeds, const Body& body) {
  for (uint64_t seed = 0; seed < test::seed_count(seeds); ++seed)
    for (const NamedMesh& family : test::mesh_families(seed)) {
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      body(family.mesh, seed);
      if (testing::Test::HasFatalFailure()) return;
    }
}

TEST(Reference, IsTheLeastHitByExactArithmetic) {
  size_t hits = 0;
  for_families(1, [&](const TriangleMesh& mesh, uint64_t seed) {
    for (const Ray& ray : test::aimed_rays(mesh, 45, seed)) {
      Hit nearest;
      for (uint32_t i = 0; i < mesh.triangle_count() && is_valid(ray); ++i) {
        Hit hit;
        if (!intersect_triangle_exact(ray, mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2), hit)) continue;
        hit.triangle = i;
        if (hit.t < nearest.t || nearest.triangle == kNoTriangle) nearest = hit;
      }
      hits += is_hit(nearest);
      ASSERT_TRUE(same_bits(intersect_reference(mesh, ray), nearest));
      ASSERT_EQ(occluded_reference(mesh, ray), is_hit(nearest));
    }
  });
  EXPECT_GT(hits, 400u);
}

TEST(Search, AgreesWithTheOracle) {
  size_t rays = 0, hits = 0;
  for_families(8, [&](const TriangleMesh& mesh, uint64_t seed) {
    const std::vector<NamedTree> trees = test::hand_made_trees(mesh);
    for (const Ray& ray : test::aimed_rays(mesh, 300, seed)) {
      const Hit expected = intersect_reference(mesh, ray);
      ++rays;
      hits += is_hit(expected);
      for (const auto& [name, bvh] : trees)
        for (const bool prune : {true, false}) {
          ASSERT_TRUE(same_bits(intersect(bvh, mesh, ray, {}, {.prune = prune}), expected)) << name << ", " << prune;
          ASSERT_EQ(occluded(bvh, mesh, ray, {.prune = prune}), is_hit(expected)) << name << ", " << prune;
        }
    }
  });
  EXPECT_GT(hits, rays / 3);
}

TEST(Search, RaysEndAtTheirHits) {
  for_families(2, [&](const TriangleMesh& mesh, uint64_t seed) {
    const Bvh bvh = test::hand_made_trees(mesh).front().bvh;
    const std::vector<Ray> rays = test::aimed_rays(mesh, 50, seed), ended = end_at_hits(rays, bvh, mesh);
    ASSERT_EQ(ended.size(), rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
      const Hit hit = intersect_reference(mesh, rays[i]);
      EXPECT_TRUE(same_bits(intersect_reference(mesh, ended[i]), hit));
      const float end = is_hit(hit) ? hit.t : rays[i].tmax;  // NaN for some that are no rays
      EXPECT_EQ(std::bit_cast<uint32_t>(ended[i].tmax), std::bit_cast<uint32_t>(end));
    }
  });
}

// A search over half of the triangles, given the best of the other half.
TEST(Search, MergesWithWhatIsKnown) {
  for_families(2, [&](const TriangleMesh& mesh, uint64_t seed) {
    std::vector<uint32_t> odd, even;
    for (const uint32_t id : test::all_triangles(mesh)) (id % 2 ? odd : even).push_back(id);
    const auto halves = [](uint32_t count, uint32_t) { return count / 2; };
    const Bvh odd_tree = test::split_tree(mesh, odd, halves), even_tree = test::split_tree(mesh, even, halves);
    for (const Ray& ray : test::aimed_rays(mesh, 200, seed + 50)) {
      const Hit expected = intersect_reference(mesh, ray);
      ASSERT_TRUE(same_bits(intersect(even_tree, mesh, ray, intersect(odd_tree, mesh, ray)), expected));
      ASSERT_TRUE(same_bits(intersect(odd_tree, mesh, ray, intersect(even_tree, mesh, ray)), expected));
      ASSERT_TRUE(same_bits(intersect(odd_tree, mesh, ray, expected), expected));
    }
  });
}

// Skipping boxes before s loses no hit at or after s, and reports none that is not there.
TEST(Search, SkipsOnlyBoxesThatTheRayHasLeft) {
  uint64_t boxes = 0, all_boxes = 0;
  for_families(2, [&](const TriangleMesh& mesh, uint64_t seed) {
    const Bvh bvh = test::hand_made_trees(mesh)[1].bvh;
    for (Ray ray : test::aimed_rays(mesh, 200, seed + 70)) {
      ray.tmin = -kInf;
      const Hit expected = intersect_reference(mesh, ray);
      const float skips[] = {expected.t, std::nextafter(expected.t, kInf), 0, 0.5f, 1, kInf};
      for (const float skip : skips) {
        Ray rest = ray;
        rest.tmin = skip;
        const Hit beyond = intersect_reference(mesh, rest);
        TraceCounters counters;
        ASSERT_TRUE(same_bits(intersect(bvh, mesh, rest, {}, {.skip_before = skip}), beyond));
        const Hit found = intersect(bvh, mesh, ray, {}, {.skip_before = skip, .prune = false}, &counters);
        ASSERT_FALSE(is_nearer(beyond, found));
        ASSERT_FALSE(is_nearer(found, expected));
        ASSERT_EQ(occluded(bvh, mesh, ray, {.skip_before = skip}) || !is_hit(beyond), true);
        boxes += counters.inner_hits + counters.leaf_hits;
        counters = {};
        intersect(bvh, mesh, ray, {}, {.prune = false}, &counters);
        all_boxes += counters.inner_hits + counters.leaf_hits;
      }
    }
  });
  EXPECT_LT(boxes, all_boxes * 3 / 4);
}

TEST(Search, EmptyTreesAndInvalidRaysReturnWhatIsKnown) {
  const NamedMesh box = test::mesh_families(1).front();
  const Bvh bvh = test::hand_made_trees(box.mesh)[1].bvh;
  const Hit known{3, 0.25f, 0.5f, 7};
  const Ray good{{0, 0, 0}, {1, 0.25f, 0.125f}};
  EXPECT_EQ(intersect(Bvh{}, {}, good, known), known);
  EXPECT_FALSE(occluded(Bvh{}, {}, good));
  EXPECT_TRUE(occluded(bvh, box.mesh, good));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Ray bad_rays[] = {{{nan, 0, 0}, {1, 0, 0}},       {{0, 0, 0}, {1, nan, 0}},    {{0, kInf, 0}, {1, 0, 0}},
                          {{0, 0, 0}, {1, -kInf, 0}},     {{0, 0, 0}, {0, 0, 0}},      {{0, 0, 0}, {1, 0, 0}, nan, 1},
                          {{0, 0, 0}, {1, 0, 0}, 0, nan}, {{0, 0, 0}, {1, 0, 0}, 2, 0}};
  for (const Ray& ray : bad_rays) {
    TraceCounters counters;
    EXPECT_EQ(intersect(bvh, box.mesh, ray, known, {}, &counters), known);
    EXPECT_EQ(intersect(bvh, box.mesh, ray), Hit{});
    EXPECT_EQ(intersect_reference(box.mesh, ray), Hit{});
    EXPECT_FALSE(occluded(bvh, box.mesh, ray, {}, &counters));
    EXPECT_FALSE(occluded_reference(box.mesh, ray));
    EXPECT_EQ(counters, TraceCounters{});
  }
}

TEST(Search, TheDeepestTreeFitsTheStack) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 300; ++i) {
    const auto x = static_cast<float>(i);
    mesh.vertices.insert(mesh.vertices.end(), {{x, -1, -1}, {x, 2, -1}, {x, -1, 2}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const auto ids = test::all_triangles(mesh);
  const Bvh left = test::split_tree(mesh, ids, [](uint32_t count, uint32_t) { return count - 1; });
  const Bvh right = test::split_tree(mesh, ids, [](uint32_t, uint32_t) { return 1u; });
  for (const Bvh* bvh : {&left, &right}) {
    ASSERT_EQ(max_level(*bvh), kMaxTreeLevels - 1);
    EXPECT_EQ(intersect(*bvh, mesh, {{-1, 0, 0}, {1, 0, 0}}).triangle, 0u);
    EXPECT_EQ(intersect(*bvh, mesh, {{400, 0, 0}, {-1, 0, 0}}).triangle, 299u);
    EXPECT_EQ(intersect(*bvh, mesh, {{150.5f, 0, 0}, {1, 0, 0}}, {}, {.prune = false}).triangle, 151u);
  }
}

}  // namespace
}  // namespace raygrain

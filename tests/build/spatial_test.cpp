// build_spatial: budgets, cheaper trees where boxes overlap, threads, and what it refuses.
#include <cstring>

#include "raygrain/error.h"

#include "build/build_support.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

TriangleMesh long_triangles(uint32_t count, uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 a = random_point(random, 0, 10), b = a + random_point(random, -6, 6);
    mesh.vertices.insert(mesh.vertices.end(), {a, b, b + random_point(random, -0.1f, 0.1f)});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// Many small triangles between a few that reach through all of the scene.
TriangleMesh small_and_large(uint32_t count, uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const float size = i % 100 == 0 ? 10.0f : 0.1f;
    const Vec3 a = random_point(random, 0, 10), b = a + random_point(random, -size, size);
    mesh.vertices.insert(mesh.vertices.end(), {a, b, b + random_point(random, -size, size)});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

BuildOptions options_for(const TriangleMesh& mesh) {
  BuildOptions options;
  options.merge_leaves = true;
  options.clip = [&mesh](uint32_t i, const Bounds& box) { return clip_triangle_bounds(mesh, i, box); };
  return options;
}

Bvh spatial(const Prims& prims, const BuildOptions& options, BuildLog* log = nullptr) {
  return build_spatial(prims.bounds, prims.centroids, options, log);
}

double estimate(const Bvh& bvh, const RayMeasure& measure) {
  double sum = 0;
  for (const Bvh::Node& node : bvh.nodes)
    sum += static_cast<double>(measure(node.bounds)) * (node.is_leaf() ? 1.2 * node.count : 2.0);
  return sum;
}

TEST(Spatial, CostsLessThanBinnedWhereLargeTrianglesReachThroughOthers) {
  const std::vector<RayMeasure> measures{RayMeasure(), face_weight_measure({0.1f, 0.2f, 0.9f})};
  for (uint64_t seed = 0; seed < 4; ++seed)
    for (const RayMeasure& measure : measures) {
      SCOPED_TRACE(seed);
      const TriangleMesh mesh = small_and_large(3000, seed);
      const Prims prims = prims_of(mesh);
      BuildOptions options = options_for(mesh);
      options.strategy.measure = measure;
      options.spatial.budget = 2;
      const Bvh split = spatial(prims, options);
      EXPECT_EQ(find_defect(split, prims.bounds), std::nullopt);
      EXPECT_TRUE(split.split_references);
      EXPECT_LT(estimate(split, measure), estimate(binned(prims, options), measure));
    }
}

TEST(Spatial, KeepsItsBudget) {
  const TriangleMesh mesh = long_triangles(3000, 7);
  const Prims prims = prims_of(mesh);
  size_t before = 0;
  for (const float budget : {0.0f, 0.1f, 0.5f, 4.0f}) {
    SCOPED_TRACE(budget);
    BuildOptions options = options_for(mesh);
    options.spatial.budget = budget;
    const Bvh bvh = spatial(prims, options);
    EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
    EXPECT_LE(static_cast<double>(bvh.prims.size()), 3000 * (1 + static_cast<double>(budget)));
    EXPECT_GE(bvh.prims.size(), before);
    EXPECT_EQ(bvh.split_references, budget > 0);
    before = bvh.prims.size();
  }
}

TEST(Spatial, WithoutOverlapIsTheBinnedTree) {
  const TriangleMesh mesh = long_triangles(500, 3);
  const Prims prims = prims_of(mesh);
  BuildOptions options = options_for(mesh);
  options.spatial.overlap = 1;
  EXPECT_TRUE(same_tree(spatial(prims, options), binned(prims, options)));
}

TEST(Spatial, GivesTheSameTreeForAnyNumberOfThreads) {
  const TriangleMesh mesh = long_triangles(40000, 2);
  const Prims prims = prims_of(mesh);
  BuildOptions options = options_for(mesh);
  options.threads = 1;
  const Bvh one = spatial(prims, options);
  EXPECT_EQ(find_defect(one, prims.bounds), std::nullopt);
  for (const unsigned threads : {2u, 8u}) {
    options.threads = threads;
    const Bvh other = spatial(prims, options);
    ASSERT_EQ(one.nodes.size(), other.nodes.size());
    EXPECT_EQ(std::memcmp(one.nodes.data(), other.nodes.data(), one.nodes.size() * sizeof(Bvh::Node)), 0);
    EXPECT_EQ(one.prims, other.prims);
  }
}

TEST(Spatial, HasNoUseForABadClip) {
  // Callbacks that deny every primitive, or answer with boxes outside: nothing is lost.
  const TriangleMesh mesh = long_triangles(400, 5);
  const Prims prims = prims_of(mesh);
  for (const Bounds& answer : {Bounds{}, Bounds{{-100, -100, -100}, {100, 100, 100}}}) {
    BuildOptions options = options_for(mesh);
    options.clip = [&](uint32_t, const Bounds&) { return answer; };
    EXPECT_EQ(find_defect(spatial(prims, options), prims.bounds), std::nullopt);
  }
}

TEST(Spatial, RefusesWhatItCannotDo) {
  const Prims prims = random_prims(20, 1);
  const auto error_of = [&](auto change) {
    BuildOptions options;
    options.clip = [](uint32_t, const Bounds& box) { return box; };
    change(options);
    try {
      spatial(prims, options);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kUsage);
      return error.where;
    }
    return std::string("no error");
  };
  EXPECT_EQ(error_of([](BuildOptions&) {}), "no error");
  EXPECT_EQ(error_of([](BuildOptions& o) { o.clip = {}; }), "clip");
  EXPECT_EQ(error_of([](BuildOptions& o) { o.strategy.cost = [](float m, uint32_t) { return m; }; }), "strategy.cost");
  EXPECT_EQ(error_of([](BuildOptions& o) { o.spatial.overlap = -1; }), "spatial.overlap");
  EXPECT_EQ(error_of([](BuildOptions& o) { o.spatial.budget = 17; }), "spatial.budget");
}

TEST(SpatialDefects, AreFound) {
  const TriangleMesh mesh = long_triangles(200, 1);
  const Prims prims = prims_of(mesh);
  const Bvh good = spatial(prims, options_for(mesh));
  ASSERT_TRUE(good.split_references);
  Bvh bad = good;
  bad.split_references = false;
  EXPECT_NE(find_defect(bad, prims.bounds), std::nullopt);
  bad = good;
  std::fill(bad.prims.begin(), bad.prims.end(), 0u);
  EXPECT_NE(find_defect(bad, prims.bounds), std::nullopt);
  const std::vector<uint32_t> expected{0, 1, 2};
  EXPECT_NE(find_defect(good, prims.bounds, expected), std::nullopt);
}

}  // namespace
}  // namespace raygrain::test

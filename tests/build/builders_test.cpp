// Every builder with every kind of options on every mesh family: valid trees, always the same, never too deep.
#include <algorithm>
#include <cmath>

#include "build/build_support.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

struct NamedBuild {
  std::string name;
  Bvh (*build)(std::span<const Bounds>, std::span<const Vec3>, const BuildOptions&, BuildLog*);
  BuildOptions options;
};

std::vector<NamedBuild> builds() {
  std::vector<NamedBuild> all;
  const auto add = [&all](const std::string& name, auto change) {
    BuildOptions options;
    options.strategy.orientation = fixed_axes({{0, 0.9f}, {2, 0.5f}, {1, 0.2f}});
    options.strategy.measure = face_weight_measure({0.2f, 0.9f, 0.4f});
    options.fallback = BuildStrategy{};
    change(options);
    all.push_back({"paper " + name, build_paper, options});
    all.push_back({"binned " + name, build_binned, options});
    all.push_back({"subset " + name, build_subset, options});
    all.push_back({"sweep " + name, build_sweep, options});
    // Cut as the boxes that they are.
    options.clip = [](uint32_t, const Bounds& box) { return box; };
    options.spatial = {0, 1};
    all.push_back({"spatial " + name, build_spatial, options});
  };
  add("default", [](BuildOptions& o) { o = {}; });
  add("preset", [](BuildOptions&) {});
  add("all axes", [](BuildOptions& o) {
    o.parameters.split_plane_quality_threshold = 0;
    o.parameters.excellent_ratio = 0;
  });
  add("two bins", [](BuildOptions& o) { o.parameters.bins = 2; });
  add("many bins", [](BuildOptions& o) { o.parameters.bins = 1000; });
  add("few levels", [](BuildOptions& o) { o.parameters.max_levels = 3; });
  add("deep", [](BuildOptions& o) { o.parameters.max_levels = kMaxTreeLevels; });
  add("deep fallback", [](BuildOptions& o) { o.parameters.max_non_fallback_levels = 2; });
  add("leaves left whole", [](BuildOptions& o) { o.split_inseparable = false; });
  add("merged leaves", [](BuildOptions& o) { o.merge_leaves = true; });
  add("a measure that sees nothing", [](BuildOptions& o) { o.strategy.measure = [](const Bounds&) { return 0.0f; }; });
  add("one along y",
      [](BuildOptions& o) { o.strategy.measure = [](const Bounds& b) { return b.hi.y > 0 ? 1.0f : 0.0f; }; });
  return all;
}

void expect_good(const NamedBuild& named, const Prims& prims) {
  BuildLog log;
  const Bvh bvh = named.build(prims.bounds, prims.centroids, named.options, &log);
  EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
  EXPECT_EQ(log.nodes.size(), bvh.nodes.size());
  EXPECT_LE(max_level(bvh), named.options.parameters.max_levels);
  const std::vector<uint32_t>& ids = bvh.prims;
  for (const Bvh::Node& node : bvh.nodes)
    EXPECT_TRUE(std::is_sorted(ids.begin() + node.first, ids.begin() + node.first + node.count));
  EXPECT_TRUE(same_tree(bvh, named.build(prims.bounds, prims.centroids, named.options, nullptr)));
}

TEST(Builders, GiveValidTreesForAllMeshFamilies) {
  const std::vector<NamedBuild> all = builds();
  for (uint64_t seed = 1; seed <= 2; ++seed)
    for (const NamedMesh& mesh : mesh_families(seed)) {
      const Prims prims = prims_of(mesh.mesh);
      for (const NamedBuild& named : all) {
        SCOPED_TRACE(testing::Message() << named.name << " on " << mesh.name << " seed " << seed);
        expect_good(named, prims);
      }
    }
}

TEST(Builders, GiveValidTreesForBoxesThatAreNoTriangles) {
  for (uint64_t seed = 0; seed < 6; ++seed) {
    Random random(seed);
    Prims prims;
    for (int i = 0; i < 120; ++i) {
      Bounds box;
      box.extend(random_point(random, -3, 3));
      if (random.below(3) > 0) box.extend(random_point(random, -3, 3));
      // Centroids may lie anywhere, even outside, and often coincide.
      prims.add(box, random.below(2) ? random_point(random, -9, 9) : Vec3{1, std::floor(box.lo.y), 1});
    }
    for (const NamedBuild& named : builds()) {
      SCOPED_TRACE(testing::Message() << named.name << " seed " << seed);
      expect_good(named, prims);
    }
  }
}

TEST(Builders, NothingGivesAnEmptyTree) {
  for (const NamedBuild& named : builds()) {
    BuildLog log;
    const Bvh bvh = named.build({}, {}, named.options, &log);
    EXPECT_TRUE(bvh.nodes.empty() && bvh.prims.empty() && log.nodes.empty()) << named.name;
  }
}

TEST(Builders, OnePrimitiveGivesOneLeaf) {
  const Prims one = cubes({{4, 5, 6}});
  for (const NamedBuild& named : builds()) {
    BuildLog log;
    const Bvh bvh = named.build(one.bounds, one.centroids, named.options, &log);
    ASSERT_EQ(bvh.nodes.size(), 1u) << named.name;
    EXPECT_EQ(bvh.nodes[0].count, 1u);
    EXPECT_EQ(bvh.nodes[0].bounds, one.bounds[0]);
    EXPECT_EQ(log.nodes[0].axis, -1);
  }
}

TEST(Builders, NoCentroidsStandForCentersOfBoxes) {
  const Prims prims = random_prims(300, 11);
  std::vector<Vec3> centers;
  for (const Bounds& box : prims.bounds) centers.push_back(center(box));
  for (const NamedBuild& named : builds()) {
    const Bvh given = named.build(prims.bounds, centers, named.options, nullptr);
    const Bvh left_out = named.build(prims.bounds, {}, named.options, nullptr);
    EXPECT_EQ(given.prims, left_out.prims) << named.name;
    EXPECT_EQ(given.nodes.size(), left_out.nodes.size()) << named.name;
  }
}

TEST(Builders, ExponentiallySpacedPrimitivesGiveDeepTreesWithoutRecursion) {
  // Each box 2.2 times as far and as large as the last. With two slices, one box falls off per level.
  Prims prims;
  float x = 1;
  for (int i = 0; i < 110; ++i, x *= 2.2f) prims.add({{x, 0, 0}, {1.5f * x, 1, 1}});
  BuildOptions options;
  options.parameters.bins = 2;
  options.parameters.max_levels = kMaxTreeLevels;
  for (const auto build : {build_paper, build_binned}) {
    const Bvh bvh = build(prims.bounds, prims.centroids, options, nullptr);
    EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
    EXPECT_GE(max_level(bvh), 109u - 8);  // small nodes may be cut between any two keys
    EXPECT_EQ(largest_leaf(bvh), 1u);
  }
}

TEST(Builders, TreesNeverGrowDeeperThanStacksAllow) {
  // A stop rule that never stops, and costs that cut off one of 400 primitives per level.
  Prims prims;
  for (int i = 0; i < 400; ++i) prims.add({{static_cast<float>(i), 0, 0}, {static_cast<float>(i) + 1, 1, 1}});
  BuildOptions options;
  options.parameters.bins = 1000;
  options.strategy.orientation = fixed_axes({{0, 1}});
  options.strategy.stop = [](const StopState&, const PaperParameters&) { return false; };
  options.strategy.cost = [](float, uint32_t count) { return -static_cast<float>(count) * static_cast<float>(count); };
  for (const auto build : {build_paper, build_binned}) {
    const Bvh bvh = build(prims.bounds, prims.centroids, options, nullptr);
    EXPECT_EQ(max_level(bvh), kMaxTreeLevels);
    EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
  }
}

TEST(Builders, IdenticalBoxesMakeNoHugeLeaf) {
  Prims prims;
  for (int i = 0; i < 10000; ++i) prims.add({{1, 2, 3}, {2, 3, 4}});
  for (const auto build : {build_paper, build_binned}) {
    BuildOptions options;
    const Bvh bvh = build(prims.bounds, prims.centroids, options, nullptr);
    EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
    EXPECT_LE(largest_leaf(bvh), options.leaf_size);
    EXPECT_LE(max_level(bvh), 13u);
    options.split_inseparable = false;
    EXPECT_EQ(largest_leaf(build(prims.bounds, prims.centroids, options, nullptr)), 10000u);
  }
}

TEST(Builders, CentroidsCloserThanSlicesAreSeparated) {
  // Two piles at neighbouring floats inside a huge box: no slice of it is that thin.
  Prims prims;
  const float a = 1, b = std::nextafter(a, kInf);
  for (int i = 0; i < 6; ++i) prims.add({{-1e6f, -1e6f, -1e6f}, {1e6f, 1e6f, 1e6f}}, {i % 2 ? a : b, 0, 0});
  BuildOptions options;
  for (const auto build : {build_paper, build_binned}) {
    const Bvh bvh = build(prims.bounds, prims.centroids, options, nullptr);
    ASSERT_EQ(bvh.nodes.size(), 3u);
    EXPECT_EQ(bvh.prims, (std::vector<uint32_t>{1, 3, 5, 0, 2, 4}));
  }
  options.split_inseparable = false;
  EXPECT_EQ(paper(prims, options).nodes.size(), 1u);
}

TEST(Builders, AMeasureThatSeesNothingGivesABalancedTree) {
  const Prims prims = random_prims(4096, 5);
  BuildOptions options;
  options.strategy.measure = [](const Bounds&) { return 0.0f; };
  options.parameters.split_plane_quality_threshold = 0;
  for (const auto build : {build_paper, build_binned}) {
    const Bvh bvh = build(prims.bounds, prims.centroids, options, nullptr);
    EXPECT_LE(max_level(bvh), 24u);
    EXPECT_EQ(largest_leaf(bvh), 1u);
  }
}

TEST(Builders, HugeBoxesDoNotOverflow) {
  Prims prims;
  const float big = 3e38f;
  for (int i = 0; i < 64; ++i) {
    const float x = big * (static_cast<float>(i) / 32 - 1);
    prims.add({{x, -big, -big}, {x, big, big}});
  }
  for (const auto build : {build_paper, build_binned}) {
    const Bvh bvh = build(prims.bounds, prims.centroids, {}, nullptr);
    EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
    EXPECT_EQ(largest_leaf(bvh), 1u);
  }
}

}  // namespace
}  // namespace raygrain::test

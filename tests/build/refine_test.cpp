// reinsert and refit: valid trees, never dearer, the same for any number of threads; what they refuse.
#include "raygrain/refine.h"

#include <algorithm>
#include <cstring>

#include "raygrain/error.h"

#include "build/build_support.h"
#include "build/estimate.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

struct NamedMeasure {
  const char* name;
  RayMeasure measure;
};

const std::vector<NamedMeasure>& measures() {
  static const std::vector<NamedMeasure> all{
      {"surface area", {}},
      {"faces", face_weight_measure({0.1f, 0.9f, 0.3f})},
      {"faces of a window", face_weight_measure({0.1f, 0.9f, 0.3f}, 50.0f)},
      {"half a space", RayMeasure([](const Bounds& b) { return b.hi.y > 0 ? std::min(extent(b).x, 1e30f) : 0.0f; })},
      {"nothing", RayMeasure([](const Bounds&) { return 0.0f; })},
      // Larger boxes may measure less: the search's bounds do not hold, the promise must.
      {"not monotone", RayMeasure([](const Bounds& b) { return 1 / (1 + length(extent(b))); })}};
  return all;
}

std::vector<Bvh> trees_of(const TriangleMesh& mesh, const Prims& prims) {
  BuildOptions options;
  options.clip = [&mesh](uint32_t i, const Bounds& box) { return clip_triangle_bounds(mesh, i, box); };
  std::vector<Bvh> trees;
  for (const auto build : {build_paper, build_binned, build_sweep, build_spatial})
    trees.push_back(build(prims.bounds, prims.centroids, options, nullptr));
  return trees;
}

TEST(Reinsert, NeverRaisesTheEstimatedCost) {
  for (uint64_t seed = 1; seed <= seed_count(4); ++seed)
    for (const NamedMesh& mesh : mesh_families(seed)) {
      const Prims prims = prims_of(mesh.mesh);
      for (const Bvh& tree : trees_of(mesh.mesh, prims))
        for (const NamedMeasure& named : measures()) {
          SCOPED_TRACE(testing::Message() << mesh.name << " seed " << seed << " " << named.name);
          Bvh better = tree;
          const ReinsertResult result = reinsert(better, named.measure);
          EXPECT_EQ(find_defect(better, prims.bounds), std::nullopt);
          EXPECT_EQ(result.cost_before, estimated_cost(tree, named.measure));
          EXPECT_EQ(result.cost_after, estimated_cost(better, named.measure));
          EXPECT_LE(result.cost_after, result.cost_before);
          EXPECT_EQ(result.moves == 0, same_tree(tree, better));
          EXPECT_EQ(better.split_references, tree.split_references);
        }
    }
}

TEST(Reinsert, LowersTheCostOfPoorTrees) {
  for (uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const Prims prims = random_prims(2000, seed);
    BuildOptions options;
    options.strategy.measure = [](const Bounds&) { return 0.0f; };
    Bvh tree = binned(prims, options);
    const ReinsertResult result = reinsert(tree, {}, {.iterations = 10});
    EXPECT_LT(result.cost_after, 0.9 * result.cost_before);
    EXPECT_GT(result.moves, 0u);
  }
}

TEST(Reinsert, SharesOfTheNodesDoLessEach) {
  const Prims prims = random_prims(2000, 1);
  const Bvh tree = binned(prims);
  Bvh all = tree, tenth = tree;
  const ReinsertResult whole = reinsert(all, {}, {.iterations = 1});
  const ReinsertResult part = reinsert(tenth, {}, {.iterations = 1, .share = 0.1f});
  EXPECT_LT(whole.cost_after, part.cost_after);
  EXPECT_LT(part.cost_after, part.cost_before);
  EXPECT_LT(part.moves, whole.moves);
}

TEST(Reinsert, GivesTheSameTreeForAnyNumberOfThreads) {
  const Prims prims = random_prims(20000, 3);
  const Bvh tree = binned(prims);
  Bvh one = tree;
  reinsert(one, {}, {.iterations = 2, .threads = 1});
  for (const unsigned threads : {2u, 8u}) {
    Bvh other = tree;
    reinsert(other, {}, {.iterations = 2, .threads = threads});
    ASSERT_EQ(one.nodes.size(), other.nodes.size());
    EXPECT_EQ(std::memcmp(one.nodes.data(), other.nodes.data(), one.nodes.size() * sizeof(Bvh::Node)), 0);
    EXPECT_EQ(one.prims, other.prims);
  }
}

TEST(Reinsert, RefusesAndCancels) {
  const Prims prims = random_prims(300, 3);
  const Bvh tree = binned(prims);
  const auto code_of = [&](const RayMeasure& measure, const ReinsertOptions& options) {
    Bvh copy = tree;
    try {
      reinsert(copy, measure, options);
    } catch (const Error& error) {
      EXPECT_TRUE(same_tree(copy, tree));
      return std::string(name(error.code));
    }
    return std::string("none");
  };
  EXPECT_EQ(code_of({}, {.share = 0}), "usage");
  EXPECT_EQ(code_of({}, {.share = 2}), "usage");
  EXPECT_EQ(code_of({}, {.costs = {-1, 1}}), "usage");
  EXPECT_EQ(code_of(RayMeasure([](const Bounds&) { return -1.0f; }), {}), "bad_heuristic");
  EXPECT_EQ(code_of({}, {.progress = [](double done) { return done < 0.2; }}), "cancelled");
  Bvh empty;
  EXPECT_EQ(reinsert(empty).cost_after, 0);
}

TEST(Refit, FitsBoxesToMovedPrimitives) {
  for (uint64_t seed = 1; seed <= seed_count(8); ++seed)
    for (const NamedMesh& mesh : mesh_families(seed)) {
      SCOPED_TRACE(testing::Message() << mesh.name << " seed " << seed);
      const Prims prims = prims_of(mesh.mesh);
      Bvh tree = binned(prims);
      const Bvh before = tree;
      EXPECT_EQ(refit(tree, prims.bounds).ratio(), 1);
      EXPECT_TRUE(same_tree(tree, before));
      Random random(seed);
      TriangleMesh moved = mesh.mesh;
      for (Vec3& p : moved.vertices) p = p * 0.5f + random_point(random, -0.1f, 0.1f);
      const Prims there = prims_of(moved);
      const RefitResult result = refit(tree, there.bounds);
      EXPECT_EQ(find_defect(tree, there.bounds), std::nullopt);
      EXPECT_EQ(result.cost_before, estimated_cost(before, {}));
      EXPECT_EQ(result.cost_after, estimated_cost(tree, {}));
    }
}

TEST(Refit, SaysWhenToRebuild) {
  const Prims prims = random_prims(3000, 1);
  Bvh tree = binned(prims);
  Prims little = prims;
  Random random(4);
  for (Bounds& box : little.bounds) {
    const Vec3 by = random_point(random, -0.02f, 0.02f);
    box = {box.lo + by, box.hi + by};
  }
  EXPECT_LT(refit(tree, little.bounds).ratio(), 1.1);
  std::vector<Bounds> shuffled = prims.bounds;
  for (size_t i = shuffled.size(); i-- > 1;) std::swap(shuffled[i], shuffled[random.below(i + 1)]);
  EXPECT_GT(refit(tree, shuffled).ratio(), 2);
}

TEST(Refit, RefusesWhatItCannotFit) {
  const Prims prims = random_prims(30, 1);
  const auto where_of = [&](Bvh tree, std::span<const Bounds> bounds) {
    try {
      refit(tree, bounds);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kUsage);
      return error.where;
    }
    return std::string("none");
  };
  Bvh split = binned(prims);
  split.split_references = true;
  EXPECT_EQ(where_of(split, prims.bounds), "tree");
  EXPECT_EQ(where_of(binned(prims), std::span(prims.bounds).first(29)), "bounds[29]");
  std::vector<Bounds> bad = prims.bounds;
  bad[7] = Bounds{};
  EXPECT_EQ(where_of(binned(prims), bad), "bounds[7]");
  EXPECT_EQ(where_of(binned(prims), prims.bounds), "none");
}

}  // namespace
}  // namespace raygrain::test

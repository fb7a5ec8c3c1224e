// What the parallel builders hold of primitives: with keys of their own or without, they build the same trees, for any
// number of threads; zeros of both signs and huge coordinates harm neither.
#include <array>
#include <limits>

#include "raygrain/error.h"
#include "raygrain/heuristics.h"

#include "build/build_support.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

using Builder = Bvh (*)(std::span<const Bounds>, std::span<const Vec3>, const BuildOptions&, BuildLog*);
constexpr std::array<Builder, 3> kBuilders{build_binned, build_spatial, build_subset};

std::vector<BuildOptions> settings(const std::vector<Bounds>& bounds) {
  BuildOptions plain;
  plain.clip = [&bounds](uint32_t i, const Bounds& box) { return intersected(bounds[i], box); };
  plain.merge_leaves = true;
  BuildOptions rare = plain;
  rare.rare_leaf_size = 8;
  rare.parameters.bins = 32;
  BuildOptions along_one_axis = rare;
  along_one_axis.strategy.orientation = longest_axis_orientation();
  along_one_axis.parameters.split_plane_quality_threshold = 1;
  BuildOptions unsplit = along_one_axis;
  unsplit.split_inseparable = false;
  return {plain, rare, along_one_axis, unsplit};
}

std::vector<Vec3> centers_of(const std::vector<Bounds>& bounds) {
  std::vector<Vec3> centers;
  centers.reserve(bounds.size());
  for (const Bounds& box : bounds) centers.push_back(center(box));
  return centers;
}

void expect_one_tree(const std::vector<Bounds>& bounds) {
  const std::vector<Vec3> centers = centers_of(bounds);
  for (size_t builder = 0; builder < kBuilders.size(); ++builder) {
    const std::vector<BuildOptions> all = settings(bounds);
    for (size_t setting = 0; setting < all.size(); ++setting) {
      SCOPED_TRACE("builder " + std::to_string(builder) + ", setting " + std::to_string(setting));
      BuildOptions options = all[setting];
      options.threads = 1;
      const Bvh tree = kBuilders[builder](bounds, {}, options, nullptr);
      EXPECT_EQ(find_defect(tree, bounds), std::nullopt);
      EXPECT_TRUE(same_tree(tree, kBuilders[builder](bounds, centers, options, nullptr))) << "keys";
      for (const unsigned threads : {2u, 8u}) {
        options.threads = threads;
        EXPECT_TRUE(same_tree(tree, kBuilders[builder](bounds, {}, options, nullptr))) << threads << " threads";
      }
    }
  }
}

TEST(References, NeedNoKeysForMiddlesOfBoxes) {
  for (const size_t count :
       {size_t{1}, size_t{2}, size_t{9}, size_t{300}, static_cast<size_t>(test::seed_count(40000))}) {
    SCOPED_TRACE(count);
    expect_one_tree(random_prims(count, count).bounds);
  }
}

TEST(References, CopeWithZerosOfBothSigns) {
  Random random(1);
  std::vector<Bounds> bounds;
  for (int i = 0; i < 20000; ++i) {
    const auto zero = [&] { return random.below(2) == 0 ? 0.0f : -0.0f; };
    const auto x = static_cast<float>(random.below(100)), y = static_cast<float>(random.below(100));
    bounds.push_back({{x, y, zero()}, {x + 1, y + 1, zero()}});
    if (i % 3 == 0) bounds.push_back({{zero(), zero(), zero()}, {zero(), zero(), zero()}});
  }
  expect_one_tree(bounds);
}

/// So near to each other that slices of many primitives are too thin for floats, and those of few are not: nodes are
/// halved first and sliced further down.
TEST(References, CopeWithKeysAtTheEndOfFloats) {
  for (const bool shuffled : {false, true})
    for (const float width : {0.0f, 1.0f}) {  // middles of boxes, or keys of their own
      Random random(4);
      std::vector<Bounds> bounds;
      std::vector<Vec3> keys;
      for (int i = 0; i < 1000; ++i) {
        const float x = static_cast<float>(shuffled ? random.below(1000) : static_cast<uint64_t>(i)) * 4e-41f;
        bounds.push_back({{width > 0 ? 0 : x, 0, 0}, {width > 0 ? width : x, 1, 1}});
        keys.push_back({x, width > 0 ? 0 : 0.5f, width > 0 ? 0 : 0.5f});
      }
      for (const BuildOptions& options : settings(bounds))
        for (const Builder build : kBuilders) {
          const Bvh tree = build(bounds, keys, options, nullptr);
          EXPECT_FALSE(find_defect(tree, bounds)) << shuffled << " " << width;
        }
    }
}

TEST(References, CopeWithSumsBeyondFloat) {
  Random random(2);
  std::vector<Bounds> bounds;
  for (int i = 0; i < 9000; ++i) {
    const Vec3 corner = random_point(random, 2e38, 3e38);
    bounds.push_back({corner, corner + Vec3{1e37f, 1e37f, 1e37f}});
  }
  expect_one_tree(bounds);
}

TEST(References, AreRefusedWhereOneBoxIsBad) {
  for (const size_t bad : {size_t{0}, size_t{17000}, size_t{39999}})
    for (const float number : {std::numeric_limits<float>::quiet_NaN(), kInf, -kInf}) {
      std::vector<Bounds> bounds = random_prims(40000, 3).bounds;
      const std::vector<Vec3> centers = centers_of(bounds);
      bounds[bad].hi.y = number;
      for (const Builder build : kBuilders) {
        const BuildOptions options = settings(bounds).front();
        EXPECT_THROW(build(bounds, {}, options, nullptr), Error);
        EXPECT_THROW(build(bounds, centers, options, nullptr), Error);
      }
    }
}

}  // namespace
}  // namespace raygrain::test

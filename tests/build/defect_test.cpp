// find_defect sees every single corruption of a good tree, and survives links from hell.
#include <cmath>
#include <functional>
#include <limits>

#include "base/random.h"
#include "build/build_support.h"

namespace raygrain::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class Defect : public testing::Test {
 protected:
  Prims prims_ = random_prims(60, 7);
  Bvh good_ = paper(prims_);

  uint32_t first_leaf(uint32_t from = 0) const {
    while (!good_.nodes[from].is_leaf()) ++from;
    return from;
  }
  void expect_defect(const std::string& part, const std::function<void(Bvh&)>& corrupt) const {
    SCOPED_TRACE(part);
    Bvh bad = good_;
    corrupt(bad);
    const auto defect = find_defect(bad, prims_.bounds);
    ASSERT_TRUE(defect.has_value());
    EXPECT_NE(defect->find(part), std::string::npos) << *defect;
  }
};

TEST_F(Defect, AcceptsAGoodTree) {
  EXPECT_EQ(find_defect(good_, prims_.bounds), std::nullopt);
  EXPECT_EQ(find_defect({}, {}), std::nullopt);
}

TEST_F(Defect, SeesBrokenLinks) {
  expect_defect("do not stand after it", [](Bvh& b) { b.nodes[0].first = 0; });
  expect_defect("do not stand after it", [](Bvh& b) { b.nodes[b.nodes[0].first].first = 0; });
  expect_defect("children out of range", [](Bvh& b) { b.nodes[0].first = static_cast<uint32_t>(b.nodes.size()) - 1; });
  expect_defect("children out of range", [](Bvh& b) { b.nodes[0].first = 0xffffffffu; });
  expect_defect("shares its child", [](Bvh& b) {
    // Some inner node takes over the children of a later one.
    for (Bvh::Node& node : b.nodes) node.bounds = b.nodes[0].bounds;
    uint32_t inner = static_cast<uint32_t>(b.nodes.size()) - 1;
    while (b.nodes[inner].is_leaf()) --inner;
    b.nodes[1].count = 0;
    b.nodes[1].first = b.nodes[2].count == 0 ? b.nodes[2].first : b.nodes[inner].first;
  });
  expect_defect("not reached", [](Bvh& b) { b.nodes.push_back(b.nodes.back()); });
}

TEST_F(Defect, SeesLeavesOutOfRange) {
  const uint32_t leaf = first_leaf();
  expect_defect("primitives out of range", [&](Bvh& b) { b.nodes[leaf].count = 1000; });
  expect_defect("primitives out of range", [&](Bvh& b) { b.nodes[leaf].first = 0xffffffffu; });
  expect_defect("primitives out of range", [&](Bvh& b) { b.nodes[leaf].count = 0xffffffffu; });
}

TEST_F(Defect, SeesWrongPrimitives) {
  expect_defect("has no box", [](Bvh& b) { b.prims[3] = 60; });
  expect_defect("holds primitive", [](Bvh& b) { b.prims[3] = b.prims[4]; });
  expect_defect("entries of the primitive list", [](Bvh& b) { b.prims.push_back(5); });
  expect_defect("", [](Bvh& b) { b.prims.pop_back(); });
  expect_defect("", [](Bvh& b) { b.prims.clear(); });
}

TEST_F(Defect, SeesMissingPrimitives) {
  Prims more = prims_;
  more.add(more.bounds[0]);
  const auto defect = find_defect(good_, more.bounds);
  ASSERT_TRUE(defect);
  EXPECT_EQ(*defect, "primitive 60 is in no leaf");
  EXPECT_EQ(find_defect({}, more.bounds), "primitive 0 is in no leaf");
  EXPECT_TRUE(find_defect({{}, {1}}, {}));
}

TEST_F(Defect, SeesBoxesThatHoldTooLittle) {
  const uint32_t leaf = first_leaf();
  expect_defect("not inside its box", [&](Bvh& b) {
    Vec3& lo = b.nodes[leaf].bounds.lo;
    lo.x = std::nextafter(lo.x, kInf);
  });
  expect_defect("does not hold the box of its child", [](Bvh& b) {
    Vec3& hi = b.nodes[0].bounds.hi;
    hi.z = std::nextafter(hi.z, -kInf);
  });
}

TEST_F(Defect, SeesNanInEveryPlace) {
  for (uint32_t node : {0u, 1u, first_leaf()})
    for (int axis = 0; axis < 3; ++axis) {
      expect_defect("NaN in its box", [&](Bvh& b) { b.nodes[node].bounds.lo[axis] = kNan; });
      expect_defect("NaN in its box", [&](Bvh& b) { b.nodes[node].bounds.hi[axis] = kNan; });
    }
}

TEST_F(Defect, ChecksExpectedPrimitivesOnly) {
  Bvh one{{{prims_.bounds[5], 0, 1}}, {5}};
  const std::vector<uint32_t> five{5}, six{6}, both{5, 6}, wild{99};
  EXPECT_EQ(find_defect(one, prims_.bounds, five), std::nullopt);
  EXPECT_TRUE(find_defect(one, prims_.bounds, six));
  EXPECT_TRUE(find_defect(one, prims_.bounds, both));
  EXPECT_TRUE(find_defect(one, prims_.bounds, wild));
  EXPECT_TRUE(find_defect(one, prims_.bounds));
}

/// A chain: every inner node has a leaf and the next inner node.
Bvh chain(uint32_t levels, const Bounds& box) {
  Bvh bvh;
  bvh.nodes.push_back({box, 1, 0});
  for (uint32_t level = 1; level <= levels; ++level) {
    const uint32_t next = level == levels ? 0 : 2 * level + 1;
    bvh.nodes.push_back({box, level - 1, 1});
    bvh.nodes.push_back({box, next == 0 ? level : next, next == 0 ? 1u : 0u});
  }
  for (uint32_t i = 0; i <= levels; ++i) bvh.prims.push_back(i);
  return bvh;
}

TEST(DefectDepth, AllowsTheDeepestTreeAndNoDeeper) {
  const Bounds box{{0, 0, 0}, {1, 1, 1}};
  const std::vector<Bounds> boxes(kMaxTreeLevels + 2, box);
  const Bvh deepest = chain(kMaxTreeLevels, box), deeper = chain(kMaxTreeLevels + 1, box);
  EXPECT_EQ(max_level(deepest), kMaxTreeLevels);
  EXPECT_EQ(find_defect(deepest, std::span(boxes).first(kMaxTreeLevels + 1)), std::nullopt);
  const auto defect = find_defect(deeper, boxes);
  ASSERT_TRUE(defect);
  EXPECT_NE(defect->find("deeper than 256"), std::string::npos);
}

TEST(DefectHostile, NeverCrashesOnRandomLinks) {
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Prims prims = random_prims(10, seed % 5);
    Bvh bvh = paper(prims);
    const auto number = [&] {
      return random.below(4) == 0 ? static_cast<uint32_t>(random.next()) : static_cast<uint32_t>(random.below(25));
    };
    bool changed = false;
    for (int i = 0; i < 3; ++i) {
      Bvh::Node& node = bvh.nodes[random.below(bvh.nodes.size())];
      uint32_t& link = random.below(2) ? node.first : node.count;
      const uint32_t value = number();
      changed = changed || value != link;
      link = value;
    }
    find_defect(bvh, prims.bounds);
    max_level(bvh);
    if (changed) continue;
    EXPECT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
  }
}

TEST(TreeSize, CountsBytesAndLevels) {
  EXPECT_EQ(memory_bytes({}), 0u);
  EXPECT_EQ(max_level({}), 0u);
  const Bvh bvh = paper(random_prims(100, 1));
  EXPECT_GE(memory_bytes(bvh), bvh.nodes.size() * 32 + 400);
  EXPECT_EQ(max_level(Bvh{{{{}, 0, 1}}, {0}}), 0u);
}

}  // namespace
}  // namespace raygrain::test

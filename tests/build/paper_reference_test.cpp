// build_paper against a slow, recursive transcription of Algorithm 1 that repartitions for every plane: same trees.
#include <algorithm>
#include <memory>

#include "build/build_support.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

struct SlowNode {
  Bounds bounds;
  std::vector<uint32_t> prims;
  std::unique_ptr<SlowNode> left, right;
};

struct Half {
  Bounds bounds;
  std::vector<uint32_t> prims;
};

struct Cut {
  Half left, right;
  double cost = 0;
  bool found = false;
};

class SlowPaper {
 public:
  SlowPaper(const Prims& prims, const BuildOptions& options) : prims_(prims), options_(options) {}

  std::unique_ptr<SlowNode> build() {
    std::vector<uint32_t> all(prims_.bounds.size());
    for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    root_ = box_of(all);
    return build(std::move(all), 0, -1);
  }

 private:
  Bounds box_of(const std::vector<uint32_t>& prims) const {
    Bounds box;
    for (const uint32_t prim : prims) box.extend(prims_.bounds[prim]);
    return box;
  }

  std::unique_ptr<SlowNode> build(std::vector<uint32_t> prims, uint32_t level, int parent_axis) {
    auto node = std::make_unique<SlowNode>();
    node->bounds = box_of(prims);
    node->prims = prims;
    const PaperParameters& p = options_.parameters;
    const bool deep = level > p.max_non_fallback_levels && options_.fallback;
    const BuildStrategy& own = deep ? *options_.fallback : options_.strategy;
    const float measure = own.measure(node->bounds), total = own.measure.total(root_);
    const float probability = total > 0 ? std::min(measure / total, 1.0f) : 0.0f;
    const float cost = probability * static_cast<float>(prims.size()) * options_.costs.triangle;
    if (prims.size() < p.max_triangles_per_leaf || prims.size() < 2 || level >= p.max_levels ||
        probability < p.max_leaf_hit_probability || measure < p.max_leaf_area || cost < p.max_leaf_cost)
      return node;
    const NodeContext context{node->bounds, static_cast<uint32_t>(prims.size()), level, parent_axis, 0};
    int axis = -1;
    Cut cut = search(own, own, context, prims, !deep, axis);
    if (!cut.found) return node;
    node->left = build(std::move(cut.left.prims), level + 1, axis);
    node->right = build(std::move(cut.right.prims), level + 1, axis);
    node->prims.clear();
    return node;
  }

  /// `pricing` sets the cost by which cuts are compared at the end; the strategy's own cost rules inside.
  Cut search(const BuildStrategy& strategy, const BuildStrategy& pricing, const NodeContext& node,
             const std::vector<uint32_t>& prims, bool may_fall_back, int& axis_out) {
    const PaperParameters& p = options_.parameters;
    Cut best;
    const float father = strategy.measure(node.bounds);
    const AxisOrder order = strategy.orientation(node);
    for (size_t k = 0; k < static_cast<size_t>(order.count); ++k) {
      const AxisChoice choice = order.choices[k];
      const float ratio = best.found && father > 0
                              ? static_cast<float>((static_cast<double>(strategy.measure(best.left.bounds)) +
                                                    static_cast<double>(strategy.measure(best.right.bounds))) /
                                                   static_cast<double>(father))
                              : kInf;
      if (best.found && ratio <= p.excellent_ratio) break;
      if (choice.quality < p.split_plane_quality_threshold) {
        if ((best.found && ratio <= p.acceptable_ratio) || !may_fall_back || !options_.fallback) break;
        int other_axis = -1;
        Cut other = search(*options_.fallback, pricing, node, prims, false, other_axis);
        if (other.found) other.cost = price(pricing, other);
        if (other.found && (!best.found || other.cost <= best.cost)) {
          best = std::move(other);
          axis_out = other_axis;
        }
        break;
      }
      for (uint32_t i = 1; i < p.bins; ++i) {
        const double lo = static_cast<double>(node.bounds.lo[choice.axis]),
                     hi = static_cast<double>(node.bounds.hi[choice.axis]);
        const auto plane = static_cast<float>(lo + (hi - lo) * (static_cast<double>(i) / p.bins));
        Cut cut = split(prims, choice.axis, plane);
        if (!cut.found) continue;
        cut.cost = price(strategy, cut);
        if (best.found && !(cut.cost < best.cost)) continue;
        best = std::move(cut);
        axis_out = choice.axis;
      }
    }
    return best;
  }

  static double price(const BuildStrategy& strategy, const Cut& cut) {
    return static_cast<double>(strategy.measure(cut.left.bounds)) * static_cast<double>(cut.left.prims.size()) +
           static_cast<double>(strategy.measure(cut.right.bounds)) * static_cast<double>(cut.right.prims.size());
  }

  Cut split(const std::vector<uint32_t>& prims, int axis, float plane) const {
    Cut cut;
    for (const uint32_t prim : prims)
      (prims_.centroids[prim][axis] < plane ? cut.left : cut.right).prims.push_back(prim);
    cut.left.bounds = box_of(cut.left.prims);
    cut.right.bounds = box_of(cut.right.prims);
    cut.found = !cut.left.prims.empty() && !cut.right.prims.empty();
    return cut;
  }

  const Prims& prims_;
  const BuildOptions& options_;
  Bounds root_;
};

/// Compares in depth; false at the first difference.
bool equals(const Bvh& bvh, uint32_t index, const SlowNode& slow) {
  const Bvh::Node& node = bvh.nodes[index];
  if (node.bounds != slow.bounds || node.is_leaf() != (slow.left == nullptr)) return false;
  if (node.is_leaf())
    return std::equal(slow.prims.begin(), slow.prims.end(), bvh.prims.begin() + node.first,
                      bvh.prims.begin() + node.first + node.count);
  return equals(bvh, node.first, *slow.left) && equals(bvh, node.first + 1, *slow.right);
}

/// Positive for every box, so that no cut is free.
RayMeasure tilted_measure(Vec3 weights) {
  return RayMeasure([weights](const Bounds& box) {
    const Vec3 e = extent(box);
    return weights.x * e.y * e.z + weights.y * e.z * e.x + weights.z * e.x * e.y + 1e-3f;
  });
}

SplitOrientation longest_first() {
  return [](const NodeContext& node) {
    const Vec3 e = extent(node.bounds);
    const float longest = std::max({e.x, e.y, e.z, 1e-30f});
    return sorted_axes({e.x / longest, e.y / longest, e.z / longest});
  };
}

/// Options that reach every branch: preset-like, always falling back, no early stop, deep fallback, leaf rules.
std::vector<BuildOptions> recipes() {
  BuildOptions base;
  base.split_inseparable = false;
  base.strategy.measure = tilted_measure({0.35f, 0.8f, 0.48f});
  base.strategy.orientation = fixed_axes({{0, 0.6f}, {2, 0.45f}, {1, 0.2f}});
  base.fallback = BuildStrategy{};
  base.fallback->measure = tilted_measure({0.5f, 0.5f, 0.5f});
  base.fallback->orientation = longest_first();
  std::vector<BuildOptions> all(7, base);
  all[1].parameters.split_plane_quality_threshold = 0.5f;
  all[1].parameters.acceptable_ratio = 0.8f;
  all[2].parameters.split_plane_quality_threshold = 0;
  all[2].parameters.excellent_ratio = 0;
  all[3].parameters.max_non_fallback_levels = 3;
  all[3].parameters.bins = 7;
  all[4].parameters.max_triangles_per_leaf = 5;
  all[4].parameters.max_leaf_hit_probability = 0.02f;
  all[4].fallback.reset();
  all[5].parameters.split_plane_quality_threshold = 0.9f;
  all[5].parameters.bins = 2;
  all[6].parameters.max_levels = 5;
  all[6].parameters.max_leaf_cost = 0.1f;
  all[6].parameters.bins = 163;
  return all;
}

void expect_same(const Prims& prims, const BuildOptions& options) {
  const Bvh bvh = paper(prims, options);
  ASSERT_EQ(find_defect(bvh, prims.bounds), std::nullopt);
  EXPECT_TRUE(equals(bvh, 0, *SlowPaper(prims, options).build()));
}

TEST(PaperReference, EqualsTheTranscriptionOnRandomTriangles) {
  const std::vector<BuildOptions> all = recipes();
  for (uint64_t seed = 0; seed < 12; ++seed)
    for (size_t i = 0; i < all.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " recipe " << i);
      expect_same(random_prims(20 + 25 * seed, seed), all[i]);
    }
}

TEST(PaperReference, EqualsTheTranscriptionOnAllMeshFamilies) {
  const std::vector<BuildOptions> all = recipes();
  for (const NamedMesh& mesh : mesh_families(3)) {
    // Areas of huge boxes overflow the simple measure of this test; builders_test covers those.
    const float longest = length(extent(mesh_bounds(mesh.mesh)));
    if (mesh.mesh.triangle_count() == 0 || !(longest < 1e15f)) continue;
    for (size_t i = 0; i < all.size(); ++i) {
      SCOPED_TRACE(testing::Message() << mesh.name << " recipe " << i);
      expect_same(prims_of(mesh.mesh), all[i]);
    }
  }
}

TEST(PaperReference, TiesGoToTheLowerPlane) {
  // Unit cubes far apart and mirrored: cutting off the first or the last costs the same.
  const Prims prims = cubes({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}});
  BuildOptions options;
  options.strategy.orientation = fixed_axes({{0, 1}});
  const Bvh bvh = paper(prims, options);
  EXPECT_EQ(bvh.nodes[1].count, 1u);
  EXPECT_EQ(bvh.nodes[2].count, 0u);
}

}  // namespace
}  // namespace raygrain::test

#include "trace/careful.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "raygrain/triangle.h"

#include "trace/walk.h"

namespace raygrain {
namespace {

/// As Slabs, for the boxes of a wide tree: they are relative to its center, so an origin may be wrong by a rounding.
class RelativeSlabs {
 public:
  RelativeSlabs(const WideTree& tree, const Ray& ray) {
    for (int axis = 0; axis < 3; ++axis) {
      const size_t i = static_cast<size_t>(axis);
      origin_[i] = static_cast<double>(ray.origin[axis]) - static_cast<double>(tree.center[axis]);
      slack_[i] = 0x1p-51 * std::abs(origin_[i]);
      direction_[i] = ray.direction[axis];
    }
  }

  /// An interval that holds every t whose point is in the box.
  Interval operator()(const WideNode& node, size_t child) const {
    double entry = -kInfinity, exit = kInfinity;
    for (size_t i = 0; i < 3; ++i) {
      const double below = node.lower[i][child] - origin_[i] - slack_[i];
      const double above = node.upper[i][child] - origin_[i] + slack_[i];
      if (direction_[i] == 0) {
        if (below > 0 || above < 0) return {kInfinity, -kInfinity};
        continue;
      }
      entry = std::max(entry, (direction_[i] > 0 ? below : above) / direction_[i]);
      exit = std::min(exit, (direction_[i] > 0 ? above : below) / direction_[i]);
    }
    return {entry - kPadding * std::abs(entry), exit + kPadding * std::abs(exit)};
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kPadding = 0x1p-49;

  double origin_[3], slack_[3], direction_[3];
};

/// Calls leaf(block) for every leaf whose box the ray may meet within `range`, until it returns false.
template <class Leaf>
void walk_wide(const WideTree& tree, const Ray& ray, const Range& range, TraceCounters& counters, const Leaf& leaf) {
  const RelativeSlabs slabs(tree, ray);
  std::vector<std::pair<double, ChildRef>> stack{{range.earliest, node_ref(0)}};
  while (!stack.empty()) {
    const auto [entry, current] = stack.back();
    stack.pop_back();
    if (entry > range.latest) continue;
    if (triangles_of(current) != 0) {
      ++counters.leaf_hits;
      counters.leaf_triangles += triangles_of(current);
      if (!leaf(tree.leaf(current))) return;
      continue;
    }
    ++counters.inner_hits;
    const WideNode& node = tree.node(current);
    const size_t first = stack.size();
    for (size_t i = 0; i < kWidth; ++i) {
      if (node.child[i] == 0) continue;
      ++counters.box_tests;
      const Interval inside = slabs(node, i);
      if (range.meets(inside)) stack.emplace_back(inside.entry, node.child[i]);
    }
    std::sort(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end(), std::greater<>());
  }
}

bool intersect_lane(const WideLeaf& leaf, size_t lane, const Ray& ray, Hit& hit, TraceCounters& counters) {
  ++counters.triangle_tests;
  if (!intersect_triangle(ray, leaf.vertex(0, lane), leaf.vertex(1, lane), leaf.vertex(2, lane), hit)) return false;
  hit.triangle = leaf.id(lane);
  return true;
}

Range range_of(const Ray& ray, const SearchOptions& options) {
  return {Range::below(std::max(ray.tmin, options.skip_before)), Range::above(ray.tmax)};
}

}  // namespace

Hit nearest_carefully(const WideTree& tree, const Ray& ray, Hit known, const SearchOptions& options,
                      TraceCounters* counters) {
  TraceCounters unwanted;
  TraceCounters& count = counters != nullptr ? *counters : unwanted;
  Range range = range_of(ray, options);
  const auto end_at = [&](float t) {
    if (options.prune) range.latest = std::min(range.latest, Range::above(t));
  };
  end_at(known.t);
  walk_wide(tree, ray, range, count, [&](const WideLeaf& leaf) {
    for (size_t lane = 0; lane < leaf.count; ++lane) {
      Hit hit;
      if (!intersect_lane(leaf, lane, ray, hit, count) || !is_nearer(hit, known)) continue;
      known = hit;
      end_at(known.t);
    }
    return true;
  });
  return known;
}

bool any_carefully(const WideTree& tree, const Ray& ray, const SearchOptions& options, TraceCounters* counters) {
  TraceCounters unwanted;
  TraceCounters& count = counters != nullptr ? *counters : unwanted;
  bool found = false;
  walk_wide(tree, ray, range_of(ray, options), count, [&](const WideLeaf& leaf) {
    for (size_t lane = 0; lane < leaf.count; ++lane) {
      Hit hit;
      if (!intersect_lane(leaf, lane, ray, hit, count)) continue;
      found = true;
      if (options.prune) return false;
    }
    return true;
  });
  return found;
}

}  // namespace raygrain

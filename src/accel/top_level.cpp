#include "raygrain/top_level.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "raygrain/error.h"

namespace raygrain {

namespace {

constexpr uint32_t kGreatestLevel = 10;

using RegionList = std::vector<uint32_t>;

/// Octant `i` of a box around its middle; the lower halves end where the upper ones begin, on the same float.
Bounds octant(const Bounds& box, Vec3 middle, int i) {
  Bounds result;
  for (int axis = 0; axis < 3; ++axis) {
    const bool upper = (i >> axis) & 1;
    result.lo[axis] = upper ? middle[axis] : box.lo[axis];
    result.hi[axis] = upper ? box.hi[axis] : middle[axis];
  }
  return result;
}

/// Makes the octree's nodes from the root down. Iterative: open cells wait on a stack with the regions of their parent.
class OctreeBuilder {
 public:
  OctreeBuilder(std::span<const ConvexRegion> regions, uint32_t greatest_level)
      : regions_(regions), greatest_level_(greatest_level) {}

  void run() {
    Bounds root;
    if (regions_.empty()) return;
    for (const ConvexRegion& region : regions_) root.extend(region_bounds(region));
    RegionList all(regions_.size());
    std::iota(all.begin(), all.end(), 0u);
    nodes_.push_back({root});
    open_.push_back({0, 0, std::move(all)});
    while (!open_.empty()) {
      Cell cell = std::move(open_.back());
      open_.pop_back();
      refine(std::move(cell));
    }
  }

  std::vector<TopLevel::Node> take_nodes() { return std::move(nodes_); }
  RegionList take_lists() { return std::move(lists_); }

 private:
  struct Cell {
    uint32_t node, level;
    RegionList candidates;  // regions of the parent
  };

  /// Conservative: a point inside a region (within slack) lies in a cell that overlaps it (within twice the slack).
  void refine(Cell cell) {
    const Bounds box = nodes_[cell.node].bounds;
    std::erase_if(cell.candidates, [&](uint32_t i) { return !overlaps(regions_[i], box); });
    const bool homogeneous =
        std::ranges::all_of(cell.candidates, [&](uint32_t i) { return encloses(regions_[i], box); });
    if (homogeneous || cell.level == greatest_level_) return close(cell);
    const auto first = static_cast<uint32_t>(nodes_.size());
    nodes_[cell.node].first_child = first;
    const Vec3 middle = center(box);
    for (int i = 0; i < 8; ++i) nodes_.push_back({octant(box, middle, i)});
    for (uint32_t i = 8; i-- > 0;) open_.push_back({first + i, cell.level + 1, cell.candidates});
  }

  /// Equal lists are stored once.
  void close(const Cell& cell) {
    const auto [known, is_new] = list_begins_.try_emplace(cell.candidates, static_cast<uint32_t>(lists_.size()));
    if (is_new) lists_.insert(lists_.end(), cell.candidates.begin(), cell.candidates.end());
    nodes_[cell.node].first_region = known->second;
    nodes_[cell.node].regions = static_cast<uint32_t>(cell.candidates.size());
  }

  std::span<const ConvexRegion> regions_;
  uint32_t greatest_level_;
  std::vector<Cell> open_;
  std::vector<TopLevel::Node> nodes_;
  RegionList lists_;
  std::map<RegionList, uint32_t> list_begins_;
};

}  // namespace

TopLevel::TopLevel(std::span<const ConvexRegion> regions, const TopLevelOptions& options)
    : kind_(options.kind), region_count_(regions.size()) {
  if (options.max_level > kGreatestLevel) {
    throw Error(ErrorCode::kUsage, "top_level.max_level", std::to_string(options.max_level) + " is too deep",
                "Use 0 ... " + std::to_string(kGreatestLevel));
  }
  if (kind_ == TopLevelKind::kList) {
    region_list_.resize(regions.size());
    std::iota(region_list_.begin(), region_list_.end(), 0u);
    return;
  }
  OctreeBuilder builder(regions, options.max_level);
  builder.run();
  nodes_ = builder.take_nodes();
  region_list_ = builder.take_lists();
}

std::span<const uint32_t> TopLevel::regions_at(Vec3 point) const {
  if (kind_ == TopLevelKind::kList) return region_list_;
  if (nodes_.empty() || !contains(nodes_.front().bounds, point)) return {};  // NaN is in no box
  const Node* node = nodes_.data();
  while (node->first_child != 0) {
    // As in `octant`: a point on the middle belongs to the upper half.
    const Vec3 middle = center(node->bounds);
    const unsigned child =
        (point.x >= middle.x ? 1u : 0u) | (point.y >= middle.y ? 2u : 0u) | (point.z >= middle.z ? 4u : 0u);
    node = &nodes_[node->first_child + child];
  }
  return std::span(region_list_).subspan(node->first_region, node->regions);
}

size_t TopLevel::memory_bytes() const {
  return sizeof(*this) + nodes_.capacity() * sizeof(Node) + region_list_.capacity() * sizeof(uint32_t);
}

}  // namespace raygrain

#include "raygrain/analyze.h"

#include "base/timer.h"

namespace raygrain {
namespace {

void set_shape(TopLevelStats& stats, const TopLevel& top_level) {
  size_t listed = 0;
  for (const TopLevel::Node& node : top_level.nodes()) {
    if (node.first_child != 0) continue;
    ++stats.leaves;
    listed += node.regions;
  }
  stats.nodes = top_level.nodes().size();
  if (stats.leaves == 0) listed = top_level.region_count();
  stats.areas_per_leaf = static_cast<double>(listed) / static_cast<double>(stats.leaves == 0 ? 1 : stats.leaves);
  stats.memory_bytes = top_level.memory_bytes();
  stats.paper_memory_bytes = paper_octree_bytes(stats.nodes, listed);
}

size_t false_candidates(const TopLevel& top_level, std::span<const ConvexRegion> regions, Vec3 point) {
  size_t count = 0;
  for (const uint32_t region : top_level.regions_at(point)) count += contains(regions[region], point) ? 0 : 1;
  return count;
}

}  // namespace

TopLevelStats analyze(const TopLevel& top_level, std::span<const ConvexRegion> regions, std::span<const Vec3> points) {
  TopLevelStats stats;
  set_shape(stats, top_level);
  if (points.empty()) return stats;
  const Timer timer;
  size_t listed = 0;
  for (const Vec3 point : points) listed += top_level.regions_at(point).size();
  stats.query_seconds = timer.seconds() / static_cast<double>(points.size());
  size_t wrong = 0;
  if (listed > 0) {
    for (const Vec3 point : points) wrong += false_candidates(top_level, regions, point);
  }
  stats.false_candidates = static_cast<double>(wrong) / static_cast<double>(points.size());
  return stats;
}

TopLevelStats analyze_top_level(std::span<const ConvexRegion> regions, const TopLevelOptions& options,
                                std::span<const Vec3> points) {
  const Timer timer;
  const TopLevel top_level(regions, options);
  const double build_seconds = timer.seconds();
  TopLevelStats stats = analyze(top_level, regions, points);
  stats.build_seconds = build_seconds;
  return stats;
}

}  // namespace raygrain

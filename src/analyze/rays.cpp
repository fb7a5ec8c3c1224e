#include <cmath>

#include "raygrain/analyze.h"

#include "analyze/chunked_sum.h"

namespace raygrain {
namespace {

struct TraceSums {
  size_t hits = 0;
  TraceCounters full, pruned;
  double squares = 0;  // of the full traversal's cost

  void add(const TraceSums& other) {
    hits += other.hits;
    full.add(other.full);
    pruned.add(other.pruned);
    squares += other.squares;
  }
};

void trace_one(const Bvh& bvh, const TriangleMesh& mesh, const Ray& ray, const CostModel& costs, TraceSums& sums) {
  TraceCounters full;
  const Hit hit = intersect(bvh, mesh, ray, {}, {.prune = false}, &full);
  intersect(bvh, mesh, ray, {}, {}, &sums.pruned);
  sums.hits += is_hit(hit) ? 1 : 0;
  sums.full.add(full);
  const double cost = ray_cost(full, costs);
  sums.squares += cost * cost;
}

/// Sample standard deviation from a sum of squares and the mean.
double deviation(double squares, double mean, double count) {
  if (count < 2) return 0;
  const double variance = (squares - count * mean * mean) / (count - 1);
  return variance > 0 ? std::sqrt(variance) : 0;
}

}  // namespace

TraceStats analyze_rays(const Bvh& bvh, const TriangleMesh& mesh, std::span<const Ray> rays, const CostModel& costs,
                        unsigned threads) {
  TraceStats stats;
  stats.rays = rays.size();
  if (rays.empty()) return stats;
  const auto sums = chunked_sum<TraceSums>(
      rays.size(), threads, [&](size_t i, TraceSums& sum) { trace_one(bvh, mesh, rays[i], costs, sum); });
  const double count = static_cast<double>(rays.size());
  stats.hits = sums.hits;
  stats.real_cost = ray_cost(sums.full, costs) / count;
  stats.pruned_cost = ray_cost(sums.pruned, costs) / count;
  stats.real_cost_deviation = deviation(sums.squares, stats.real_cost, count);
  stats.hit_ratio = static_cast<double>(sums.hits) / count;
  stats.inner_hits = static_cast<double>(sums.full.inner_hits) / count;
  stats.leaf_hits = static_cast<double>(sums.full.leaf_hits) / count;
  stats.leaf_triangles = static_cast<double>(sums.full.leaf_triangles) / count;
  return stats;
}

}  // namespace raygrain

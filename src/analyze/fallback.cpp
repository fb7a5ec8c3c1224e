#include "raygrain/analyze.h"

#include "analyze/chunked_sum.h"

namespace raygrain {
namespace {

struct FallbackSums {
  size_t served = 0, accepted = 0;
  TraceCounters local;        // of the rays that the area serves
  TraceCounters global_hit;   // of the rays with an accepted local hit, had they used the global tree
  TraceCounters global_miss;  // of the others, which need it

  void add(const FallbackSums& other) {
    served += other.served;
    accepted += other.accepted;
    local.add(other.local);
    global_hit.add(other.global_hit);
    global_miss.add(other.global_miss);
  }
};

constexpr SearchOptions kFull{.prune = false};

/// Searches the local tree where its area serves the ray; was a hit accepted?
bool search_local(const LocalTree& local, const AreaGeometry& geometry, const TriangleMesh& mesh, const Ray& ray,
                  FallbackSums& sums) {
  if (!is_valid(ray) || ray.tmin < 0 || !geometry.serves(ray)) return false;
  ++sums.served;
  const Hit hit = intersect(*local.tree, mesh, ray, {}, kFull, &sums.local);
  if (!is_hit(hit) || hit.t > exit_distance(geometry.region(), ray)) return false;
  ++sums.accepted;
  return true;
}

}  // namespace

FallbackStats analyze_fallback(const LocalTree& local, const Bvh& global, const TriangleMesh& mesh,
                               std::span<const Ray> rays, const CostModel& costs, unsigned threads) {
  FallbackStats stats;
  stats.rays = rays.size();
  if (rays.empty()) return stats;
  const AreaGeometry geometry(local.area);
  const auto sums = chunked_sum<FallbackSums>(rays.size(), threads, [&](size_t i, FallbackSums& sum) {
    const bool accepted = search_local(local, geometry, mesh, rays[i], sum);
    intersect(global, mesh, rays[i], {}, kFull, accepted ? &sum.global_hit : &sum.global_miss);
  });
  const double count = static_cast<double>(rays.size());
  const double local_sum = ray_cost(sums.local, costs);
  const double miss_sum = ray_cost(sums.global_miss, costs);
  const size_t misses = rays.size() - sums.accepted;
  stats.served = sums.served;
  if (sums.served > 0) stats.local_cost = local_sum / static_cast<double>(sums.served);
  if (misses > 0) stats.local_miss_cost = miss_sum / static_cast<double>(misses);
  stats.cost_with_fallback = (local_sum + miss_sum) / count;
  stats.global_cost = (ray_cost(sums.global_hit, costs) + miss_sum) / count;
  stats.hit_ratio = static_cast<double>(sums.accepted) / count;
  stats.break_even = break_even_hit_ratio(local_sum / count, stats.local_miss_cost, stats.global_cost);
  return stats;
}

}  // namespace raygrain

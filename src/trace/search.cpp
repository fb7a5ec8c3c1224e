#include <algorithm>

#include "raygrain/trace.h"
#include "raygrain/triangle.h"

#include "trace/walk.h"

namespace raygrain {
namespace {

bool intersect_triangle_of(const TriangleMesh& mesh, uint32_t triangle, const Ray& ray, Hit& hit) {
  if (!intersect_triangle(ray, mesh.vertex(triangle, 0), mesh.vertex(triangle, 1), mesh.vertex(triangle, 2), hit))
    return false;
  hit.triangle = triangle;
  return true;
}

bool finds_nothing(const Bvh& bvh, const Ray& ray) {
  return bvh.nodes.empty() || !is_valid(ray) || !(ray.tmin <= ray.tmax);
}

Range range_of(const Ray& ray, const SearchOptions& options) {
  return {Range::below(std::max(ray.tmin, options.skip_before)), Range::above(ray.tmax)};
}

template <bool kCounting>
Hit nearest(const Bvh& bvh, const TriangleMesh& mesh, Ray ray, Hit best, const SearchOptions& options,
            TraceCounters* counters) {
  Range range = range_of(ray, options);
  const auto end_at_best = [&] {
    ray.tmax = std::min(ray.tmax, best.t);
    if (options.prune) range.latest = Range::above(ray.tmax);
  };
  end_at_best();
  walk<kCounting>(bvh, Slabs(ray), range, counters, [&](const Bvh::Node& leaf) {
    if constexpr (kCounting) counters->triangle_tests += leaf.count;
    for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      Hit hit;
      if (!intersect_triangle_of(mesh, bvh.prims[i], ray, hit) || !is_nearer(hit, best)) continue;
      best = hit;
      end_at_best();
    }
    return true;
  });
  return best;
}

template <bool kCounting>
bool any(const Bvh& bvh, const TriangleMesh& mesh, const Ray& ray, const SearchOptions& options,
         TraceCounters* counters) {
  bool found = false;
  walk<kCounting>(bvh, Slabs(ray), range_of(ray, options), counters, [&](const Bvh::Node& leaf) {
    for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      if constexpr (kCounting) ++counters->triangle_tests;
      Hit hit;
      if (!intersect_triangle_of(mesh, bvh.prims[i], ray, hit)) continue;
      found = true;
      if (options.prune) return false;
    }
    return true;
  });
  return found;
}

}  // namespace

Hit intersect(const Bvh& bvh, const TriangleMesh& mesh, const Ray& ray, Hit known, const SearchOptions& options,
              TraceCounters* counters) {
  if (finds_nothing(bvh, ray)) return known;
  return counters ? nearest<true>(bvh, mesh, ray, known, options, counters)
                  : nearest<false>(bvh, mesh, ray, known, options, nullptr);
}

bool occluded(const Bvh& bvh, const TriangleMesh& mesh, const Ray& ray, const SearchOptions& options,
              TraceCounters* counters) {
  if (finds_nothing(bvh, ray)) return false;
  return counters ? any<true>(bvh, mesh, ray, options, counters) : any<false>(bvh, mesh, ray, options, nullptr);
}

std::vector<Ray> end_at_hits(std::span<const Ray> rays, const Bvh& bvh, const TriangleMesh& mesh) {
  std::vector<Ray> ended(rays.begin(), rays.end());
  for (Ray& ray : ended) {
    const Hit hit = intersect(bvh, mesh, ray);
    if (is_hit(hit)) ray.tmax = hit.t;
  }
  return ended;
}

}  // namespace raygrain

// What the rays of an area are expected to cost through each of its structures: the steps of sample rays, counted, each
// at its price.
#include "accel/route_costs.h"

#include <algorithm>
#include <cmath>

#include "raygrain/rays.h"

#include "geometry/cone_directions.h"

namespace raygrain {
namespace {

constexpr size_t kSamples = 256;

/// Nanoseconds of a processor of 2023 (AVX-512), trees of 100,000 triangles, found by a fit to single rays of the
/// scenes in docs/performance-rays.md. Only their relations matter.
struct TreePrices {
  double start, node, leaf, confirmation;

  double of(const TraceCounters& c) const {
    return node * static_cast<double>(c.inner_hits) + leaf * static_cast<double>(c.leaf_hits) +
           confirmation * static_cast<double>(c.triangle_tests);
  }
};
constexpr TreePrices kWidePrices{15, 20, 28, 25}, kColumnPrices{35, 22, 24, 110}, kConePrices{55, 24, 38, 110};
constexpr double kWalk = 180;  // a local search: finding the area, and how far its region reaches
/// Of a coverage: a ray, a triangle of its cell, an intersection; and how much longer a ray waits for a grid of twice
/// the size, from a megabyte on, and from 15 megabytes on.
constexpr double kCell = 27, kCellConfirmation = 35, kFarther = 5, kMuchFarther = 8;
constexpr double kCellTest = 11.5, kCellTestInCache = 7;  // the latter for any hits, in grids of up to a megabyte

/// log2(1 + x), with lines between the powers of two: the library's logarithms differ.
double octaves(double x) {
  int exponent = 0;
  const double fraction = std::frexp(1 + x, &exponent);  // in [1/2, 1)
  return exponent - 2 + 2 * fraction;
}

struct Samples {
  std::vector<Ray> along, off;
};

/// Directions spread over the cap of the area's tolerance, around each ray's own.
void spread(const InfluenceArea& area, std::vector<Ray>& rays) {
  const double tolerance = std::min(0.9, static_cast<double>(area.tolerance));
  for (size_t i = 0; i < rays.size(); ++i) {
    const Vec3d d = to_double(rays[i].direction);
    const Frame axes = make_frame(to_double(rays[i].origin), d, {});
    rays[i].direction = to_float(cone_direction(axes, tolerance, i, rays.size()) * length(d));
  }
}

std::vector<Ray> from_surfaces(const TriangleMesh& mesh, const AreaGeometry& geometry, uint64_t seed) {
  SurfaceRays rays{TowardsDirection{to_float(geometry.frame().forward)}};
  if (!geometry.is_plane()) rays.target = TowardsPoint{std::get<PointArea>(geometry.area().shape).eye};
  std::vector<Ray> found;
  for (const size_t tries : {4 * kSamples, 64 * kSamples}) {  // a small window sees little of a large scene
    if (!found.empty()) break;
    found = cast_rays(rays, mesh, tries, seed);
    std::erase_if(found, [&](const Ray& ray) { return !geometry.serves(ray); });
  }
  if (found.size() > kSamples) found.resize(kSamples);
  return found;
}

Samples samples_of(const TriangleMesh& mesh, const AreaGeometry& geometry, std::span<const Ray> given, bool any,
                   uint64_t seed) {
  Samples samples;
  samples.along = any ? from_surfaces(mesh, geometry, seed) : cast_rays(AreaRays{geometry.area()}, kSamples, seed);
  if (!given.empty()) {
    samples.off.assign(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(std::min(kSamples, given.size())));
    return samples;
  }
  samples.off = samples.along;
  spread(geometry.area(), samples.off);
  return samples;
}

class Pricing {
 public:
  Pricing(const PricedParts& parts, bool any) : parts_(parts), any_(any) {}

  WayCosts of(size_t area, const Samples& samples) const {
    WayCosts costs;
    costs.has_samples = !samples.along.empty();
    costs.global = by_global(samples.along);
    costs.off_global = by_global(samples.off);
    if (parts_.has_locals) {
      costs.local = by_local(area, samples.along);
      costs.off_local = by_local(area, samples.off);
    }
    if (area < parts_.coverages.size()) costs.coverage = by_coverage(area, samples.along, costs.global);
    return costs;
  }

 private:
  static double per_ray(double sum, size_t rays) { return rays == 0 ? 0 : sum / static_cast<double>(rays); }

  double by_global(std::span<const Ray> rays) const {
    AcceleratorCounters counters;
    for (const Ray& ray : rays) parts_.trace(any_, ray, {}, counters);
    return kWidePrices.start + per_ray(kWidePrices.of(counters.global), rays.size());
  }

  double by_local(size_t area, std::span<const Ray> rays) const {
    if (rays.empty()) return WayCosts::kNone;
    Route route;
    route.searches.assign(parts_.geometries.size(), 0);
    route.searches[area] = 1;
    route.searches_some = true;
    double sum = 0;
    for (const Ray& ray : rays) {
      AcceleratorCounters c;
      parts_.trace(any_, ray, route, c);
      const TreePrices& local = c.columns > 0 ? kColumnPrices : c.cones > 0 ? kConePrices : kWidePrices;
      sum += static_cast<double>(c.local_searches) * (kWalk + local.start) + local.of(c.local);
      sum += static_cast<double>(c.global_searches) * kWidePrices.start + kWidePrices.of(c.global);
    }
    return per_ray(sum, rays.size());
  }

  /// As a batch, which counts. Rays that coverage leaves cost the cell and the global tree.
  double by_coverage(size_t area, std::span<const Ray> rays, double global) const {
    const Coverage& coverage = parts_.coverages[area];
    if (!coverage.is_useful() || rays.empty()) return WayCosts::kNone;
    const bool is_plane = parts_.geometries[area].is_plane();
    std::vector<Vec3> points;
    for (const Ray& ray : rays) points.push_back(is_plane || any_ ? ray.origin : ray.direction);
    std::vector<uint8_t> flags(rays.size());
    std::vector<Hit> hits(rays.size());
    std::vector<uint32_t> rest;
    CoverageCounters c;
    const Vec3 common = is_plane ? rays[0].direction : std::get<PointArea>(parts_.geometries[area].area().shape).eye;
    if (is_plane && any_) coverage.occluded(points, common, flags, rest, {}, 1, &c);
    if (is_plane && !any_) coverage.intersect(points, common, hits, rest, {}, 1, &c);
    if (!is_plane && any_) coverage.occluded_towards(points, common, flags, rest, {}, 1, &c);
    if (!is_plane && !any_) coverage.intersect_from(common, points, hits, rest, {}, 1, &c);
    const double megabytes = static_cast<double>(coverage.memory_bytes()) * 0x1p-20, size = octaves(megabytes);
    const double sum = (any_ && megabytes <= 1 ? kCellTestInCache : kCellTest) * static_cast<double>(c.triangle_tests) +
                       kCellConfirmation * static_cast<double>(c.confirmations) +
                       global * static_cast<double>(rest.size());
    return kCell + kFarther * size + kMuchFarther * std::max(0.0, size - 4) + per_ray(sum, rays.size());
  }

  const PricedParts& parts_;
  const bool any_;
};

}  // namespace

ManyShares shares_of_many(Isa isa, size_t bytes) {
  if (isa != Isa::kAvx512 && isa != Isa::kAvx2) return {};  // rays are searched one after the other
  // Measured (docs/performance-rays.md, "A ray of many"): the larger the tree, the longer a ray alone waits for memory.
  const double any = std::max(0.3, 0.67 - 0.045 * octaves(static_cast<double>(bytes) * 0x1p-20));
  return {any, any + 0.1};
}

std::vector<AreaCosts> predict_costs(const PricedParts& parts, const SampleSource& source) {
  std::vector<AreaCosts> costs;
  for (size_t i = 0; i < parts.geometries.size(); ++i) {
    const AreaGeometry& geometry = parts.geometries[i];
    std::vector<Ray> given = source ? source(&geometry.area()) : std::vector<Ray>{};
    std::erase_if(given, [&](const Ray& ray) { return !geometry.serves(ray); });
    AreaCosts area;
    for (const bool any : {true, false})
      (any ? area.any : area.nearest) =
          Pricing(parts, any).of(i, samples_of(parts.mesh, geometry, given, any, 2 * i + (any ? 1 : 0)));
    costs.push_back(area);
  }
  return costs;
}

}  // namespace raygrain

// Any hits of ranges that begin or end at a hit, a float's step beside it, a little further, or nowhere: on every
// instruction set, alone, in arrays, and counted, against brute force.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "raygrain/build.h"
#include "raygrain/trace.h"
#include "raygrain/wide.h"

#include "support/mesh_families.h"

namespace raygrain {
namespace {

std::vector<float> ends_about(float t) {
  constexpr float kMost = std::numeric_limits<float>::max(), kLeast = std::numeric_limits<float>::denorm_min();
  return {t,
          std::nextafter(t, kInf),
          std::nextafter(t, -kInf),
          t * (1 + 1e-6f),
          t * (1 - 1e-6f),
          0,
          kLeast,
          -kLeast,
          1e-40f,
          kInf,
          -kInf,
          kMost,
          -kMost};
}

/// The ray with each of those ends as its first or last t.
std::vector<Ray> with_ends_about(const Ray& ray, float t) {
  std::vector<Ray> rays;
  for (const float end : ends_about(t)) {
    rays.push_back(ray), rays.back().tmin = end;
    rays.push_back(ray), rays.back().tmax = end;
    rays.push_back(ray), rays.back().tmin = end, rays.back().tmax = t;
  }
  return rays;
}

std::vector<Ray> rays_to_ask(const TriangleMesh& mesh, uint64_t seed) {
  std::vector<Ray> rays;
  for (const Ray& ray : test::aimed_rays(mesh, 60, seed)) {
    const Hit hit = intersect_reference(mesh, ray);
    if (!is_hit(hit)) continue;
    const std::vector<Ray> more = with_ends_about(ray, hit.t);
    rays.insert(rays.end(), more.begin(), more.end());
  }
  return rays;
}

TEST(AnyHits, KnowTheEndsOfTheirRanges) {
  size_t asked = 0, occluded = 0;
  for (uint64_t seed = 0; seed < test::seed_count(2); ++seed)
    for (const test::NamedMesh& family : test::mesh_families(seed)) {
      SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
      const TriangleMesh& mesh = family.mesh;
      const std::vector<Ray> rays = rays_to_ask(mesh, seed);
      std::vector<uint8_t> expected;
      for (const Ray& ray : rays) expected.push_back(occluded_reference(mesh, ray) ? 1 : 0);
      const Bvh binary = build_binned(triangle_bounds(mesh), triangle_centroids(mesh), {});
      for (const Isa isa : supported_isas()) {
        const WideBvh tree(binary, mesh, {.isa = isa});
        std::vector<uint8_t> flags(rays.size());
        tree.occluded(rays, flags);
        for (size_t i = 0; i < rays.size(); ++i) {
          TraceCounters counters;
          const bool is_right = flags[i] == expected[i] && tree.occluded(rays[i]) == (expected[i] != 0) &&
                                tree.occluded_counted(rays[i], counters, {.prune = false}) == (expected[i] != 0);
          ASSERT_TRUE(is_right) << name(isa) << ", ray " << i << " of " << rays.size() << ", tmin " << rays[i].tmin
                                << ", tmax " << rays[i].tmax;
          occluded += expected[i];
        }
        asked += rays.size();
      }
    }
  EXPECT_GT(occluded, asked / 4);
  EXPECT_GT(asked - occluded, asked / 8);
}

}  // namespace
}  // namespace raygrain

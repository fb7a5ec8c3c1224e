#include "raygrain/rays.h"
#include "raygrain/report.h"

#include "base/parallel.h"

namespace raygrain {

CostImage cost_image(const Bvh& bvh, const TriangleMesh& mesh, const InfluenceArea& area, uint32_t width,
                     uint32_t height, const CostModel& costs, unsigned threads) {
  const std::vector<Ray> rays = window_grid_rays(area, width, height);
  CostImage image{width, height, std::vector<float>(rays.size())};
  parallel_for(height, 8, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin * width; i < end * width; ++i) {
      TraceCounters counters;
      intersect(bvh, mesh, rays[i], {}, {}, &counters);
      image.cost[i] = costs.inner * static_cast<float>(counters.inner_hits) +
                      costs.triangle * static_cast<float>(counters.leaf_triangles);
    }
  });
  return image;
}

}  // namespace raygrain

// The ray sets of the benchmark, seeded and the same on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "raygrain/mesh.h"
#include "raygrain/ray.h"
#include "raygrain/wide.h"

namespace raygrain::bench {

struct BenchRays {
  std::string name;
  bool any = false;  // the query: any hit, or the closest
  std::vector<Ray> rays;
};

/// camera, camera_shuffled, diffuse, ao, segments, segments_any: about `count` rays each. `tree` finds where camera
/// rays meet the scene: diffuse and ambient-occlusion rays start there, shuffled.
std::vector<BenchRays> general_ray_sets(const TriangleMesh& mesh, const WideBvh& tree, size_t count);

}  // namespace raygrain::bench

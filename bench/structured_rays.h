// Rays with structure: of a sun, a lamp, a pinhole, a sun's disc and an area light, with the areas that know them.
#pragma once

#include <string>
#include <vector>

#include "raygrain/accelerator.h"

#include "race.h"

namespace raygrain::bench {

/// What a set's rays share, and with it raygrain's interface for batches of them.
enum class Sharing { kDirection, kEnd, kStart, kNothing };

struct StructuredRays {
  BenchRays set;
  Sharing sharing = Sharing::kNothing;
  Vec3 common;               // direction, end or start
  std::vector<Vec3> points;  // origins, or directions where the start is shared
  std::vector<InfluenceArea> areas;
  std::string structure;  // what the areas have beyond the global tree: sun, lamp or camera
};

/// sun_any, sun_closest_scan, sun_closest_shuffled, point_any, pinhole_closest_scan, pinhole_closest_shuffled,
/// disc_any_0.27, disc_any_5, rect_any, foreign_any, foreign_closest: about `count` rays each. Surface points are moved
/// 1e-4 of the scene's diagonal off the surface.
std::vector<StructuredRays> structured_ray_sets(const TriangleMesh& mesh, size_t count);

/// Rays from surface points towards the sun, whose light travels along `light`.
StructuredRays sun_rays(const TriangleMesh& mesh, Vec3 light, size_t count);

/// Our answer to a part of a set, by the batch interface that fits.
void trace_batch(const Accelerator& accelerator, const StructuredRays& rays, Answers& answers, unsigned threads);
void trace_singly(const Accelerator& accelerator, const StructuredRays& rays, Answers& answers, unsigned threads);
void trace_array(const Accelerator& accelerator, const StructuredRays& rays, Answers& answers, unsigned threads);

}  // namespace raygrain::bench

// The questions that an area is for, as its users ask them.
#pragma once

#include <vector>

#include "raygrain/accelerator.h"

namespace raygrain {

/// Rays that share a direction, an end or a start.
struct AreaQuestions {
  bool any = false;
  std::vector<Ray> rays;
  Vec3 common;               // a plane area's direction, or a point area's point
  std::vector<Vec3> points;  // origins, or the directions from the point

  size_t size() const { return rays.size(); }
};

/// Any hits: from surfaces inside the area's region against its direction or to its point. Nearest hits: from the face
/// where its rays start along its direction, or from its point. Up to `count` rays, seeded; fewer where surfaces are
/// seldom in the region.
AreaQuestions questions_of(const AreaGeometry& area, const TriangleMesh& mesh, bool any, size_t count, uint64_t seed);

/// Answers, of which one kind is asked for.
struct AreaAnswers {
  explicit AreaAnswers(size_t count) : hits(count), flags(count) {}
  std::vector<Hit> hits;
  std::vector<uint8_t> flags;
};

/// In one call for all, by the calls that are for them; on one thread.
void ask_together(const Accelerator& scene, const AreaQuestions& questions, bool is_plane, AreaAnswers& answers,
                  AcceleratorCounters* counters);
/// In one call for each ray.
void ask_one_by_one(const Accelerator& scene, const AreaQuestions& questions, AreaAnswers& answers,
                    AcceleratorCounters* counters);

}  // namespace raygrain

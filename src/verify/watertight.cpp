#include "verify/watertight.h"

#include <cmath>

namespace raygrain::verification {

std::optional<bool> crosses_evenly(const Oracle& oracle, const Ray& line) {
  if (!is_valid(line)) return {};
  const Oracle::Crossings crossings = oracle.crossings(line);
  if (crossings.touches_edge) return {};
  if (crossings.count % 2 == 0) return true;
  // A line in the plane of a triangle touches its edges without meeting it.
  if (oracle.touches_any_edge(line)) return {};
  return false;
}

std::vector<Hit> hits_in_order(const AnswerRays& structure, const Ray& line) {
  std::vector<Hit> hits;
  RayGroup group{RayGroupKind::kMixed, {}, {line}};
  Ray& ray = group.rays[0];
  ray.tmin = -kInf;
  ray.tmax = kInf;
  while (true) {
    Hit hit;
    uint8_t any = 0, told = 0;
    float until = kInf;
    structure(group, {{&hit, 1}, {&any, 1}, {&told, 1}, {&until, 1}});
    if (!is_hit(hit)) return hits;
    hits.push_back(hit);
    if (hit.t == kInf) return hits;
    ray.tmin = std::nextafter(hit.t, kInf);
  }
}

}  // namespace raygrain::verification

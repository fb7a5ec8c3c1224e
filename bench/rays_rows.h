// What races over rays with structure have in common: contestants, and rows of the table.
#pragma once

#include <memory>
#include <utility>

#include "race_whole.h"
#include "structured_rays.h"
#include "suite.h"

namespace raygrain::bench {

inline Contestant contestant(const StructuredRays& rays, std::function<void(Answers&)> trace) {
  Contestant c;
  c.trace = std::move(trace);
  c.answers = std::make_unique<Answers>(rays.set.rays.size());
  return c;
}

inline Row structured_row(const BenchScene& scene, const StructuredRays& rays, unsigned threads) {
  Row row;
  row.suite = "rays";
  row.scene = scene.name;
  row.triangles = scene.mesh.triangle_count();
  row.rays = rays.set.name;
  row.query = rays.set.any ? "any" : "closest";
  row.threads = threads;
  return row;
}

inline double mrays(const StructuredRays& rays, double seconds) {
  return static_cast<double>(rays.set.rays.size()) / seconds * 1e-6;
}

}  // namespace raygrain::bench

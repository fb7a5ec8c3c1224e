// What the rays of an area are expected to cost through each of its structures.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "raygrain/accelerator.h"

#include "accel/routes.h"

namespace raygrain {

/// What is priced. `coverages` are parallel to `geometries`, or there are none.
struct PricedParts {
  const TriangleMesh& mesh;
  std::span<const AreaGeometry> geometries;
  std::span<const Coverage> coverages;
  bool has_locals;
  std::function<void(bool any, const Ray&, const Route&, AcceleratorCounters&)> trace;
};

/// By area. `source` gives sample rays; an area without any of its own gets seeded ones: from surfaces for any hit,
/// from where its rays start for the nearest. None may be found along an area: then no way along it is priced but the
/// global one.
std::vector<AreaCosts> predict_costs(const PricedParts& parts, const SampleSource& source);

/// What a ray of many costs a tree of so many bytes.
ManyShares shares_of_many(Isa isa, size_t bytes);

}  // namespace raygrain

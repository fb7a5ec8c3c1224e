// What the areas of a light or a camera have beyond the global tree: how long it takes to build and what it holds.
#pragma once

#include <span>
#include <vector>

#include "raygrain/accelerator.h"

#include "structured_rays.h"
#include "suite.h"

namespace raygrain::bench {

/// The accelerators of the suite of rays.
AcceleratorOptions rays_options();

/// A row for each structure of the sets and each count of threads: the areas' coverage, that of each area alone and the
/// global tree of preset `best` with its collapse are built by turns, and the least time of each counts.
std::vector<AreaBuildRow> measure_area_builds(const BenchScene& scene, std::span<const StructuredRays> sets,
                                              const std::vector<unsigned>& threads);

}  // namespace raygrain::bench

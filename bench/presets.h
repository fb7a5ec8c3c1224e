// raygrain's quality presets as the benchmark builds them.
#pragma once

#include <string>

#include "raygrain/build.h"
#include "raygrain/mesh.h"
#include "raygrain/registry.h"
#include "raygrain/wide.h"

#include "suite.h"

namespace raygrain::bench {

const char* name(Quality quality);

/// On so many threads (0 = all).
Bvh build_preset(const TriangleMesh& mesh, Quality quality, unsigned threads);

/// A row for every preset, thread count and Embree's quality that corresponds: LOW to fast, MEDIUM to balanced, HIGH to
/// best. Times are the least of several builds, ours with the wide tree.
void measure_builds(const BenchScene& scene, const Settings& settings, Results& results);

}  // namespace raygrain::bench

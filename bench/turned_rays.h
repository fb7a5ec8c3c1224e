// What obliqueness costs.
#pragma once

#include "suite.h"

namespace raygrain::bench {

/// Rays towards a sun, on one thread: the scene and its sun turned together ("turned"), the first of them copied as
/// many times ("again": what equals differ by on this machine), and the fixed scene under as many suns ("directions").
/// Scenes of 300,000 triangles and more are left out: all of a kind are there at once.
void run_turned(const BenchScene& scene, const Settings& settings, Results& results);

}  // namespace raygrain::bench

// Frames of every kind, for property tests.
#pragma once

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/ray_frame.h"

#include "base/random.h"
#include "geometry/area_support.h"
#include "support/mesh_families.h"

namespace raygrain::test {

/// Calls check(frame, area, random) for frames of every kind.
template <class Check>
void for_frames(uint64_t seeds, const Check& check) {
  for (uint64_t seed = 1; seed <= seed_count(seeds); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    InfluenceArea made = random_area(random, seed % 2 == 0);
    if (seed % 4 == 1) widen(made, random);
    const AreaGeometry area(made);
    for (const FrameKind kind : frame_kinds(area)) {
      SCOPED_TRACE(name(kind));
      check(*area_frame(kind, area), area, random);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

}  // namespace raygrain::test

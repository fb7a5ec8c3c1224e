// The library's families under the tests' names, and how many seeds a property test takes.
#pragma once

#include <cstdint>

#include "raygrain/families.h"

namespace raygrain::test {

using raygrain::aimed_rays;
using raygrain::mesh_families;
using raygrain::NamedMesh;

/// How many seeds a property test takes: `usual`, a quarter of it where the environment says RAYGRAIN_TEST_SCALE=small
/// (instrumented builds), ten times as many for RAYGRAIN_TEST_SCALE=full. At least one.
uint64_t seed_count(uint64_t usual);

/// RAYGRAIN_TEST_SCALE=full: for tests that take minutes.
bool is_full_scale();

}  // namespace raygrain::test

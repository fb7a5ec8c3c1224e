// What comparisons are counted under.
#pragma once

#include <string>
#include <vector>

#include "raygrain/verify.h"

namespace raygrain::verification {

/// See VerifyTally::comparisons_of: what the structure is for this scene. Structures of users have their rays' aspect
/// alone.
std::vector<std::string> aspects_of(const std::string& structure, const VerifyScene& scene, RayGroupKind rays);

/// What answers that say how they were found (RayAnswers::told) are counted under besides: "columns" and "cones",
/// "coverage: batch" and "coverage: single", "accelerator: batch".
std::vector<std::string> aspects_told(const std::string& structure, uint8_t told);

}  // namespace raygrain::verification

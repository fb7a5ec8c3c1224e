// What comparisons are counted under.
#pragma once

#include <string>
#include <vector>

#include "raygrain/verify.h"

namespace raygrain::verification {

/// See VerifyTally::comparisons_of. Structures of users have their rays' aspect alone.
std::vector<std::string> aspects_of(const std::string& structure, RayGroupKind rays);

}  // namespace raygrain::verification

// same_bits where tests look for it.
#pragma once

#include "geometry/same_bits.h"

namespace raygrain::test {

using raygrain::same_bits;

}  // namespace raygrain::test

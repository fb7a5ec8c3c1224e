#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "support/mesh_families.h"

namespace raygrain::test {

namespace {

bool is_scale(std::string_view name) {
  const char* scale = std::getenv("RAYGRAIN_TEST_SCALE");
  return scale != nullptr && scale == name;
}

}  // namespace

uint64_t seed_count(uint64_t usual) {
  if (is_full_scale()) return 10 * usual;
  return is_scale("small") ? std::max<uint64_t>(usual / 4, 1) : usual;
}

bool is_full_scale() {
  return is_scale("full");
}

}  // namespace raygrain::test

#include <algorithm>
#include <cstdlib>
#include <string>

#include "support/mesh_families.h"

namespace raygrain::test {

uint64_t seed_count(uint64_t usual) {
  const char* scale = std::getenv("RAYGRAIN_TEST_SCALE");
  const std::string name = scale ? scale : "";
  if (name == "full") return 10 * usual;
  return name == "small" ? std::max<uint64_t>(usual / 4, 1) : usual;
}

}  // namespace raygrain::test

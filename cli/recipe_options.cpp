#include "cli/recipe_options.h"

#include "cli/values.h"

namespace raygrain::cli {

Recipe recipe_option(const std::string& option, const std::string& name, const Registry& registry) {
  return from_option(option, ErrorCode::kUsage, [&] { return parse_recipe(name, registry); });
}

void check_measure_option(const std::string& option, const std::string& name, const Registry& registry) {
  recipe_option(option, name + "+ALL", registry);
}

Quality quality_option(const std::string& name) {
  return from_option("--quality", ErrorCode::kUsage, [&] { return parse_quality(name); });
}

}  // namespace raygrain::cli

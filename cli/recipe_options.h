// Options that name recipes, measures and qualities. All failures are Error (kUsage) that names the option.
#pragma once

#include <string>

#include "raygrain/registry.h"

namespace raygrain::cli {

Recipe recipe_option(const std::string& option, const std::string& name, const Registry& registry);
void check_measure_option(const std::string& option, const std::string& name, const Registry& registry);
/// Of --quality.
Quality quality_option(const std::string& name);

}  // namespace raygrain::cli

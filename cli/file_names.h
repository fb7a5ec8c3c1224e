// File names from names of areas.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace raygrain::cli {

/// One name per area, safe on every file system and different from each other: letters, digits, + - _ and . stay, all
/// else becomes _.
std::vector<std::string> file_names(std::span<const std::string> areas);

}  // namespace raygrain::cli

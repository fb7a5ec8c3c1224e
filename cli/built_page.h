// The interactive pages that are built with npm and lie beside the program.
#pragma once

#include <string>

namespace raygrain::cli {

/// The path of a page as it is built or installed: PREFIX/share/raygrain/NAME beside PREFIX/bin. Empty where there is
/// none.
std::string built_page(const std::string& name);

}  // namespace raygrain::cli

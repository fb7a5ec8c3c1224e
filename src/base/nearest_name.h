// "Did you mean ...": the known name nearest to a mistyped one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace raygrain {

/// The name of least edit distance (insertions, deletions, replacements and swaps of neighbours, whatever the case),
/// the first on a tie; empty when none is near (more than a third of the longer word would change).
std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names);

/// "Known: a, b, c".
std::string known_names(std::span<const std::string_view> names);

/// "Did you mean "near"?", or else the known names.
std::string suggestion(std::string_view word, std::span<const std::string_view> names);

}  // namespace raygrain

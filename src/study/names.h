// What names of studies and their rows may be, and what to say where a study has no rows.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "raygrain/study.h"

namespace raygrain::study {

/// A name goes into a line of results.csv and of messages: no control characters.
bool is_plain_name(std::string_view name);

/// Upper and lower case are the same, as in recipes.
bool is_same_name(std::string_view a, std::string_view b);

template <class Entries>
bool is_known_name(const Entries& entries, std::string_view name) {
  return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) { return is_same_name(entry.name, name); });
}

/// What must hold of a study before its first row runs. Throws Error: kUsage (two rows with one key, names that are
/// not plain, no rows), kNotFound (no rows, since files are missing).
void check_study(const Study& study);

/// Throws Error (kNotFound): what was asked for is known, and its files are missing.
[[noreturn]] void fail_without_rows(const std::string& study, const std::vector<std::string>& missing);

}  // namespace raygrain::study

// results.csv as text: cells, lines, the columns of a study.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "raygrain/study.h"

namespace raygrain::study {

/// Names of the key's columns: the first four lead every row, the others come after the study's own columns.
inline constexpr size_t kKeyColumns = 8, kLeadingKeys = 4;

/// scene, kind, variant, combo, the study's columns, setting, ray_set, seed, repeat, commit, compiler, cpu.
std::vector<std::string> header_of(const Study& study);

/// Cells in the order of header_of.
std::vector<std::string> row_of(const StudyKey& key, const std::vector<std::string>& cells,
                                const StudyEnvironment& environment);

/// The key in a row that row_of made; nothing if it is none.
std::optional<StudyKey> key_of(const std::vector<std::string>& row);

/// For people: "Wood plane parallel PAH+SPFH".
std::string describe(const StudyKey& key);

/// A line of RFC 4180 CSV without its end.
std::string csv_line(const std::vector<std::string>& cells);
/// Nothing for a line that is no CSV.
std::optional<std::vector<std::string>> parse_csv_line(std::string_view line);

}  // namespace raygrain::study

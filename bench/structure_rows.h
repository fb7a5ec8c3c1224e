// Rows of the suite `structures`: as they come, as JSON, and at last as the tables of docs/performance-rays.md.
#pragma once

#include <span>

#include <nlohmann/json_fwd.hpp>

#include "suite.h"

namespace raygrain::bench {

/// Adds to the results and prints at once.
void report(const StructureRow& row, Results& results);

nlohmann::ordered_json to_json(const StructureRow& row);

/// In Markdown, for each size of scenes and each number of threads; scripts/paste-tables.sh puts them into a document.
void print_structure_tables(std::span<const StructureRow> rows);

}  // namespace raygrain::bench

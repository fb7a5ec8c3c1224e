// Which metrics the program shows, and in which order.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "raygrain/report.h"
#include "raygrain/scene.h"

#include "cli/output.h"

namespace raygrain::cli {

/// The columns of the table for people: what users pay first.
std::span<const FieldId> table_columns();

/// The columns for programs: the main ones always, then every other that any of the rows has.
std::vector<FieldId> all_columns(std::span<const ReportRow> rows);

/// All values of one row, a line each, with their meanings.
std::string row_listing(const ReportRow& row);

/// The JSON report of a scene's rows.
std::string rows_json(const std::string& scene, size_t triangles, uint64_t seed, const CommonOptions& common,
                      std::span<const ReportRow> rows);

}  // namespace raygrain::cli

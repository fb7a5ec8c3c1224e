#include <fmt/format.h>

#include "raygrain/report.h"

namespace raygrain {

namespace {

/// RFC 4180: quoted where it must be, quotes doubled.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + "\"";
}

bool any_has(std::span<const ReportRow> rows, FieldId id) {
  for (const ReportRow& row : rows)
    if (row.values.has(id)) return true;
  return false;
}

}  // namespace

std::string csv_table(std::span<const ReportRow> rows, std::span<const FieldId> columns) {
  std::string text = "name,area";
  for (const FieldId id : columns)
    if (any_has(rows, id)) text += fmt::format(",{}", field(id).name);
  text += "\r\n";
  for (const ReportRow& row : rows) {
    text += quoted(row.name) + "," + quoted(row.area);
    for (const FieldId id : columns) {
      if (!any_has(rows, id)) continue;
      // "{}" writes the fewest digits that read back as the same number.
      text += row.values.has(id) ? fmt::format(",{}", row.values[id]) : ",";
    }
    text += "\r\n";
  }
  return text;
}

}  // namespace raygrain

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "raygrain/report.h"

#include "base/quantity_text.h"

namespace raygrain {

namespace {

constexpr size_t kGap = 2;  // spaces between columns

struct Column {
  std::vector<std::string> header;  // lines
  std::vector<std::string> cells;
  bool right_aligned = true;
  size_t width = 0;
};

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool is_share(const Field& f) {
  return f.highest <= 1 || contains(f.name, "ratio");
}

/// Splits "cost_with_fallback" into lines of whole words, as few as fit into `width` letters.
std::vector<std::string> wrapped_name(std::string_view name, size_t width) {
  std::vector<std::string> lines;
  while (!name.empty()) {
    const size_t end = std::min(name.find('_'), name.size());
    const std::string word(name.substr(0, end));
    name.remove_prefix(std::min(end + 1, name.size()));
    if (!lines.empty() && lines.back().size() + 1 + word.size() <= width)
      lines.back() += " " + word;
    else
      lines.push_back(word);
  }
  return lines;
}

size_t longest(std::span<const std::string> lines) {
  size_t width = 0;
  for (const std::string& line : lines) width = std::max(width, line.size());
  return width;
}

Column text_column(const std::string& header, std::span<const ReportRow> rows, std::string ReportRow::*member) {
  Column column{{header}, {}, false, 0};
  for (const ReportRow& row : rows) column.cells.push_back(row.*member);
  column.width = std::max(header.size(), longest(column.cells));
  return column;
}

/// Digits after the point of a time: three significant ones in all.
int seconds_decimals(double seconds) {
  if (!(seconds > 0) || !std::isfinite(seconds)) return 0;
  return std::clamp(2 - static_cast<int>(std::floor(std::log10(seconds))), 0, 9);
}

/// The decimals that all cells of a column share, so that their points stand below each other; none for the field's own
/// form.
std::optional<int> column_decimals(FieldId id, std::span<const ReportRow> rows) {
  double largest = 0;
  for (const ReportRow& row : rows)
    if (row.values.has(id)) largest = std::max(largest, row.values[id]);
  if (field(id).unit == "s") return seconds_decimals(largest);
  const bool whole = std::all_of(rows.begin(), rows.end(), [&](const ReportRow& row) {
    return !row.values.has(id) || row.values[id] == std::floor(row.values[id]);
  });
  if (whole || !field(id).unit.empty() || is_share(field(id))) return std::nullopt;
  return 2;
}

Column value_column(FieldId id, std::span<const ReportRow> rows) {
  Column column;
  const std::optional<int> decimals = column_decimals(id, rows);
  for (const ReportRow& row : rows) {
    const bool own_form = !row.values.has(id) || !decimals;
    column.cells.push_back(own_form ? value_text(id, row.values[id])
                                    : fmt::format("{:.{}f}", row.values[id], *decimals));
  }
  column.header = wrapped_name(field(id).name, longest(column.cells));
  column.width = std::max(longest(column.header), longest(column.cells));
  return column;
}

std::vector<Column> make_columns(std::span<const ReportRow> rows, std::span<const FieldId> ids) {
  std::vector<Column> columns{text_column("name", rows, &ReportRow::name)};
  const bool many_areas =
      std::any_of(rows.begin(), rows.end(), [&](const ReportRow& r) { return r.area != rows[0].area; });
  if (many_areas) columns.insert(columns.begin(), text_column("area", rows, &ReportRow::area));
  for (const FieldId id : ids)
    if (std::any_of(rows.begin(), rows.end(), [&](const ReportRow& r) { return r.values.has(id); }))
      columns.push_back(value_column(id, rows));
  return columns;
}

template <class CellOf>
void append_line(std::string& text, std::span<const Column> columns, const CellOf& cell_of) {
  std::string line;
  for (const Column& column : columns) {
    const std::string cell = cell_of(column);
    const std::string space(column.width - cell.size(), ' ');
    if (!line.empty() || &column != columns.data()) line.append(kGap, ' ');
    line += column.right_aligned ? space + cell : cell + space;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  text += line + "\n";
}

}  // namespace

std::string value_text(FieldId id, double value) {
  const Field& f = field(id);
  if (std::isnan(value)) return "-";
  if (f.unit == "B") return bytes_text(value);
  if (f.unit == "s") return fmt::format("{:.{}f}", value, seconds_decimals(value));
  if (is_share(f)) return fmt::format("{:.3f}", value);
  const bool whole = value == std::floor(value) && !contains(f.name, "cost");
  return fmt::format("{:.{}f}", value, whole ? 0 : 2);
}

std::string text_table(std::span<const ReportRow> rows, std::span<const FieldId> columns) {
  if (rows.empty()) return {};
  const std::vector<Column> shown = make_columns(rows, columns);
  size_t header_lines = 0;
  for (const Column& column : shown) header_lines = std::max(header_lines, column.header.size());

  std::string text;
  for (size_t line = 0; line < header_lines; ++line)
    append_line(text, shown, [&](const Column& column) {
      const size_t missing = header_lines - column.header.size();
      return line < missing ? std::string{} : column.header[line - missing];
    });
  append_line(text, shown, [](const Column& column) { return std::string(column.width, '-'); });
  for (size_t row = 0; row < rows.size(); ++row) {
    if (row > 0 && rows[row].area != rows[row - 1].area) text += "\n";
    append_line(text, shown, [&](const Column& column) { return column.cells[row]; });
  }
  return text;
}

std::string verdict(const ReportRow& best, const ReportRow& baseline) {
  const auto cost = [](const ReportRow& row) { return row.values[FieldId::kPrunedCost]; };
  const std::string start = best.area.empty() ? "" : best.area + ": ";
  if (best.values[FieldId::kTriangles] == 0) return start + "no triangle lies in this area.";
  if (best.name == baseline.name || !(cost(baseline) > 0))
    return fmt::format("{}{} is best, at a cost of {:.2f} per ray.", start, best.name, cost(best));
  const double ratio = cost(best) / cost(baseline);
  return fmt::format("{}{} costs {:.2f}x of {}: {:.2f} instead of {:.2f} per ray.", start, best.name, ratio,
                     baseline.name, cost(best), cost(baseline));
}

}  // namespace raygrain

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "raygrain/study_report.h"

#include "report/charts.h"

namespace raygrain {

namespace {

constexpr size_t kMostValues = 400;  // in one table: more belong into the CSV

/// Text that must not be read as Markdown or break a table.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("|*_`<>[]\\").find(c) != std::string_view::npos) result += '\\';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result;
}

void append_row(std::string& text, const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) text += "| " + plain(cell) + " ";
  text += "|\n";
}

void append_table(std::string& text, const ChartTable& table) {
  if (table.rows.empty()) return;
  append_row(text, table.columns);
  for (size_t i = 0; i < table.columns.size(); ++i) text += "|---";
  text += "|\n";
  for (const auto& row : table.rows) append_row(text, row);
  text += "\n";
}

std::string row_name(const ChartPoint& point) {
  return point.group.empty() ? short_number(point.x) : point.group;
}

/// Groups by series; a published value stands in brackets behind the measured one.
ChartTable values_table(const ChartPanel& panel) {
  ChartTable table;
  if (panel.kind == ChartKind::kPoints || panel.measured.size() > kMostValues) return table;
  table.columns.push_back(panel.x.title.empty() ? "" : panel.x.title);
  std::map<std::pair<std::string, std::string>, std::string> cells;
  std::vector<std::string> names = panel.groups;
  for (const ChartPoint& point : panel.measured) {
    cells[{row_name(point), point.series}] = short_number(point.y);
    if (std::find(names.begin(), names.end(), row_name(point)) == names.end()) names.push_back(row_name(point));
  }
  for (const ChartPoint& point : panel.published)
    cells[{row_name(point), point.series}] += " (" + short_number(point.y) + ")";
  for (const ChartSeries& series : panel.series) table.columns.push_back(series.name);
  for (const std::string& name : names) {
    std::vector<std::string>& row = table.rows.emplace_back(1, name);
    for (const ChartSeries& series : panel.series) row.push_back(cells[{name, series.name}]);
  }
  return table;
}

void append_panel(std::string& text, const ChartPanel& panel, const std::string& picture) {
  text += fmt::format("**{}** ({}{})\n\n", plain(panel.title), plain(panel.y.title),
                      panel.published.empty() ? "" : "; published values in brackets");
  if (!picture.empty()) text += fmt::format("![{}]({})\n\n", plain(panel.title), picture);
  append_table(text, values_table(panel));
}

}  // namespace

std::string report_markdown(const StudyReport& report,
                            const std::function<std::string(const Chart&, size_t panel)>& picture) {
  std::string text = "# " + plain(report.title) + "\n\n";
  for (const auto& [name, fact] : report.facts) text += fmt::format("- **{}**: {}\n", plain(name), plain(fact));
  for (const auto& [name, address] : report.links) text += fmt::format("- [{}]({})\n", plain(name), address);
  for (const ChartSection& section : report.sections) {
    text += fmt::format("\n## {}\n\n{}\n", plain(section.title), plain(section.text));
    for (const Chart& chart : section.charts) {
      text += fmt::format("\n### {}{}{}\n\n{}: {}\n\n", plain(chart.label), chart.label.empty() ? "" : ". ",
                          plain(chart.title), std::string("*") + name(chart.verdict) + "*", plain(chart.finding));
      for (size_t i = 0; i < chart.panels.size(); ++i)
        append_panel(text, chart.panels[i], picture ? picture(chart, i) : "");
      append_table(text, chart.table);
      for (const std::string& note : chart.notes) text += "- " + plain(note) + "\n";
    }
  }
  return text;
}

}  // namespace raygrain

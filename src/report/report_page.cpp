// The report as one HTML file: the interactive page filled with data, or plain HTML with SVG pictures.
#include <fmt/format.h>

#include "raygrain/study_report.h"

#include "report/drawing.h"
#include "report/page_template.h"

namespace raygrain {

namespace {

constexpr std::string_view kPlace = "@RAYGRAIN_REPORT@";  // in a JSON script element of the built page

constexpr const char* kStyle = R"(
:root{color-scheme:light dark}
body{font:16px/1.5 system-ui,sans-serif;max-width:76rem;margin:0 auto;padding:1rem;color:#212529;background:#fff}
h1{font-size:1.6rem}h2{margin-top:3rem;border-bottom:1px solid #ccc}h3{margin:2rem 0 .25rem}
svg,img{max-width:100%;height:auto;display:block;margin:.5rem 0}
table{border-collapse:collapse;display:block;overflow-x:auto}td,th{padding:.2rem .7rem;border-bottom:1px solid #ddd;text-align:left}
.verdict{font-size:.8rem;border:1px solid;border-radius:1rem;padding:.05rem .6rem;white-space:nowrap}
.note{color:#5f6770;font-size:.9rem}
@media(prefers-color-scheme:dark){body{color:#e9ecef;background:#16181c}.note{color:#adb5bd}}
@media print{article{break-inside:avoid}body{color:#000;background:#fff}}
)";

std::string table_html(const ChartTable& table) {
  if (table.rows.empty()) return {};
  std::string text = "<table><tr>";
  for (const std::string& column : table.columns) text += "<th>" + escaped(column) + "</th>";
  for (const auto& row : table.rows) {
    text += "</tr>\n<tr>";
    for (const std::string& cell : row) text += "<td>" + escaped(cell) + "</td>";
  }
  return text + "</tr></table>\n";
}

std::string chart_html(const Chart& chart) {
  const std::string label = chart.label.empty() ? "" : chart.label + ". ";
  std::string text = fmt::format("<article id=\"{}\"><h3>{}</h3>\n<p><span class=\"verdict\">{}</span> {}</p>\n",
                                 chart.id, escaped(label + chart.title), name(chart.verdict), escaped(chart.finding));
  for (const ChartPanel& panel : chart.panels) text += chart_svg(panel);
  text += table_html(chart.table);
  for (const std::string& note : chart.notes) text += "<p class=\"note\">" + escaped(note) + "</p>\n";
  return text + "</article>\n";
}

}  // namespace

std::string interactive_page(const StudyReport& report, const std::string& page, const std::string& path) {
  return filled_page(page, kPlace, script_safe(study_report_json(report)), {"report page", "report-page"}, path);
}

std::string static_page(const StudyReport& report, const std::string& note) {
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\"><title>{0}</title><style>{1}</style></head>\n<body><h1>{0}</"
      "h1>\n",
      escaped(report.title), kStyle);
  if (!note.empty()) text += "<p class=\"note\">" + escaped(note) + "</p>\n";
  for (const auto& [name, fact] : report.facts)
    text += "<p class=\"note\"><b>" + escaped(name) + "</b>: " + escaped(fact) + "</p>\n";
  for (const auto& [name, address] : report.links)
    text += "<p class=\"note\"><a href=\"" + escaped(address) + "\">" + escaped(name) + "</a></p>\n";
  for (const ChartSection& section : report.sections) {
    text += fmt::format("<section id=\"{}\"><h2>{}</h2>\n<p>{}</p>\n", section.id, escaped(section.title),
                        escaped(section.text));
    for (const Chart& chart : section.charts) text += chart_html(chart);
    text += "</section>\n";
  }
  return text + "</body></html>\n";
}

}  // namespace raygrain

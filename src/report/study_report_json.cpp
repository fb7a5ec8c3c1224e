#include <cmath>

#include <nlohmann/json.hpp>

#include "raygrain/study_report.h"

namespace raygrain {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// Names in the order of ChartKind and Verdict.
constexpr const char* kKinds[] = {"bars", "ranking", "dots", "points", "lines", "matrix"};
constexpr const char* kVerdicts[] = {"confirms", "partly", "contradicts", "extends", "incomparable", "missing"};

Json points_json(const std::vector<ChartPoint>& points) {
  Json list = Json::array();
  for (const ChartPoint& p : points) {
    Json point{{"series", p.series}, {"y", number(p.y)}};
    if (!p.group.empty()) point["group"] = p.group;
    if (std::isfinite(p.x)) point["x"] = p.x;
    if (p.count != 1) {
      point["low"] = number(p.low);
      point["high"] = number(p.high);
      point["count"] = p.count;
    }
    if (!p.label.empty()) point["label"] = p.label;
    list.push_back(std::move(point));
  }
  return list;
}

Json axis_json(const ChartAxis& axis) {
  return {{"title", axis.title}, {"logarithmic", axis.logarithmic}};
}

Json panel_json(const ChartPanel& panel) {
  Json series = Json::array();
  for (const ChartSeries& s : panel.series) series.push_back({{"name", s.name}, {"colour", s.colour}});
  return {{"title", panel.title},
          {"kind", kKinds[static_cast<size_t>(panel.kind)]},
          {"x", axis_json(panel.x)},
          {"y", axis_json(panel.y)},
          {"groups", panel.groups},
          {"series", std::move(series)},
          {"measured", points_json(panel.measured)},
          {"published", points_json(panel.published)},
          {"reference", number(panel.reference)}};
}

Json chart_json(const Chart& chart) {
  Json panels = Json::array();
  for (const ChartPanel& panel : chart.panels) panels.push_back(panel_json(panel));
  return {{"id", chart.id},
          {"label", chart.label},
          {"title", chart.title},
          {"finding", chart.finding},
          {"verdict", kVerdicts[static_cast<size_t>(chart.verdict)]},
          {"verdictText", name(chart.verdict)},
          {"notes", chart.notes},
          {"panels", std::move(panels)},
          {"table", {{"columns", chart.table.columns}, {"rows", chart.table.rows}}}};
}

}  // namespace

std::string study_report_json(const StudyReport& report) {
  Json facts = Json::array(), links = Json::array(), sections = Json::array();
  for (const auto& [name, text] : report.facts) facts.push_back({{"name", name}, {"text", text}});
  for (const auto& [name, address] : report.links) links.push_back({{"name", name}, {"address", address}});
  for (const ChartSection& section : report.sections) {
    Json charts = Json::array();
    for (const Chart& chart : section.charts) charts.push_back(chart_json(chart));
    sections.push_back(
        {{"id", section.id}, {"title", section.title}, {"text", section.text}, {"charts", std::move(charts)}});
  }
  const Json json{{"title", report.title},
                  {"facts", std::move(facts)},
                  {"links", std::move(links)},
                  {"sections", std::move(sections)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace raygrain

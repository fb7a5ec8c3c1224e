#include <cmath>

#include <nlohmann/json.hpp>

#include "raygrain/report.h"

namespace raygrain {

namespace {

using Json = nlohmann::ordered_json;

/// Whole numbers without a fraction, so that counts read as counts; what JSON cannot hold as null.
Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == std::floor(value) && std::abs(value) < 0x1p53) return static_cast<int64_t>(value);
  return value;
}

}  // namespace

std::string report_json(const std::string& scene, size_t triangles, uint64_t seed, const Environment& environment,
                        std::span<const ReportRow> rows, std::span<const FieldId> columns) {
  Json report;
  report["scene"] = scene;
  report["triangles"] = triangles;
  report["seed"] = seed;
  report["environment"] = Json{{"commit", environment.commit},
                               {"compiler", environment.compiler},
                               {"cpu", environment.cpu},
                               {"threads", environment.threads}};
  report["rows"] = Json::array();
  for (const ReportRow& row : rows) {
    Json values{{"name", row.name}, {"area", row.area}};
    for (const FieldId id : columns) values[std::string(field(id).name)] = number(row.values[id]);
    report["rows"].push_back(std::move(values));
  }
  // A file name that is no UTF-8 must not make the report fail.
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace raygrain

// All figures as JSON. null: not measured.
#include <cmath>

#include <nlohmann/json.hpp>

#include "raygrain/io.h"
#include "raygrain/report.h"

#include "ratios.h"
#include "structure_rows.h"
#include "suite.h"

namespace raygrain::bench {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json to_json(const std::optional<T>& x) {
  return x ? Json(*x) : Json();
}
Json positive(double x) {
  return x > 0 ? Json(x) : Json();
}
Json mode(const std::string& name) {
  return name.empty() ? Json() : Json(name);
}

/// Keys begin with `prefix`.
void add_differences(Json& json, const std::string& prefix, const std::optional<Differences>& d) {
  json[prefix + "differences"] = d ? Json(d->count) : Json();
  json[prefix + "oracle_asked"] = d ? Json(d->asked) : Json();
  json[prefix + "oracle_agrees"] = d ? Json(d->agreed) : Json();
}

/// null without a structure.
void add_costs(Json& json, const std::optional<AreaBuildRow>& s) {
  json["structure"] = s ? Json(s->structure) : Json();
  json["build_seconds"] = s ? Json(s->build_seconds) : Json();
  json["area_build_seconds"] = s ? Json(s->area_build_seconds) : Json();
  json["global_best_build_seconds"] = s ? Json(s->global_best_build_seconds) : Json();
  json["memory_bytes"] = s ? Json(s->memory_bytes) : Json();
  json["area_memory_bytes"] = s ? Json(s->area_memory_bytes) : Json();
  json["global_memory_bytes"] = s ? Json(s->global_memory_bytes) : Json();
  json["global_wide_memory_bytes"] = s ? Json(s->global_wide_memory_bytes) : Json();
}

Json to_json(const AreaBuildRow& s) {
  Json json{{"scene", s.scene}, {"triangles", s.triangles}, {"threads", s.threads}};
  add_costs(json, s);
  return json;
}

/// What rows of the suite of rays have beyond the others.
void add_structure(const Row& r, Json& json) {
  add_differences(json, "sorted_", r.sorted_differences);
  json.update({{"embree_sorted_mrays", positive(r.embree_sorted_mrays)},
               {"embree_sorted_mode", mode(r.embree_sorted_mode)},
               {"ratio_sorted", to_json(ratio_sorted(r))},
               {"global_mrays", positive(r.global_mrays)},
               {"ratio_global", to_json(ratio_global(r))}});
  add_costs(json, r.area_build);
  const double rays = r.break_even_rays.value_or(0);
  json["break_even_rays"] = !r.break_even_rays ? Json() : std::isfinite(rays) ? Json(std::ceil(rays)) : Json("never");
  if (r.turn >= 0) json.update({{"turn", r.turn}, {"cost", to_json(r.cost)}, {"global_cost", to_json(r.global_cost)}});
}

Json to_json(const Row& r) {
  Json json{{"suite", r.suite},
            {"scene", r.scene},
            {"triangles", r.triangles},
            {"rays", r.rays},
            {"query", r.query},
            {"api", r.api},
            {"threads", r.threads},
            {"raygrain_mrays", r.raygrain_mrays},
            {"raygrain_tree", r.tree},
            {"embree_single_mrays", positive(r.embree_single_mrays)},
            {"embree_single_mode", mode(r.embree_single_mode)},
            {"embree_best_mrays", positive(r.embree_best_mrays)},
            {"embree_best_mode", mode(r.embree_best_mode)},
            {"ratio_single", to_json(ratio_single(r))},
            {"ratio_best", to_json(ratio_best(r))}};
  add_differences(json, "", r.differences);
  if (r.suite == "rays") add_structure(r, json);
  return json;
}

Json to_json(const BuildRow& b) {
  return {{"scene", b.scene},
          {"triangles", b.triangles},
          {"preset", b.preset},
          {"threads", b.threads},
          {"raygrain_seconds", b.raygrain_seconds},
          {"embree_seconds", b.embree_seconds},
          {"embree_quality", b.embree_quality},
          {"ratio", to_json(ratio_of(b))},
          {"raygrain_bytes", b.raygrain_bytes},
          {"embree_bytes", b.embree_bytes},
          {"sah_cost", b.sah_cost}};
}

Json to_json(const SizeRow& r) {
  return {{"scene", r.scene},
          {"triangles", r.triangles},
          {"rays", r.rays},
          {"size", r.size},
          {"threads", r.threads},
          {"batch_ns", positive(r.batch)},
          {"single_ns", positive(r.single)},
          {"array_ns", positive(r.array)},
          {"global_ns", positive(r.global)}};
}

Json geometric_means(const Results& results) {
  Json json = Json::object();
  for (const auto& [name, m] : means_of_rows(results))
    json[name] = {{"ratio_single", to_json(m.single.value())}, {"ratio_best", to_json(m.best.value())}};
  for (const auto& [name, m] : means_of_sets(results))
    json[name] = {{"ratio_single", to_json(m.single.value())},
                  {"ratio_best", to_json(m.best.value())},
                  {"ratio_sorted", to_json(m.sorted.value())},
                  {"ratio_global", to_json(m.global.value())}};
  for (const auto& [name, mean] : means_of_builds(results)) json[name] = {{"ratio", to_json(mean.value())}};
  for (const auto& [name, m] : scaling(results))
    json["scaling_" + name] = {{"raygrain", to_json(m.single.value())}, {"embree_single", to_json(m.best.value())}};
  return json;
}

}  // namespace

void save_json(const Results& results, const std::string& path) {
  const Environment environment = current_environment(0);
  Json json{{"environment",
             {{"commit", environment.commit},
              {"compiler", environment.compiler},
              {"cpu", environment.cpu},
              {"threads", environment.threads}}}};
  json["rows"] = Json::array();
  for (const Row& row : results.rows) json["rows"].push_back(to_json(row));
  json["area_builds"] = Json::array();
  for (const AreaBuildRow& row : results.area_builds) json["area_builds"].push_back(to_json(row));
  json["builds"] = Json::array();
  for (const BuildRow& row : results.builds) json["builds"].push_back(to_json(row));
  json["sizes"] = Json::array();
  for (const SizeRow& row : results.sizes) json["sizes"].push_back(to_json(row));
  json["structures"] = Json::array();
  for (const StructureRow& row : results.structures) json["structures"].push_back(to_json(row));
  json["geomean"] = geometric_means(results);
  write_file_atomically(path, [&](std::ostream& out) { out << json.dump(2) << '\n'; });
}

}  // namespace raygrain::bench

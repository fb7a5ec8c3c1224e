#include "cli/trace_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/environment_json.h"

namespace raygrain::cli {

namespace {

using Json = nlohmann::ordered_json;

Json work(const TraceCounters& c) {
  return {{"inner_hits", c.inner_hits},
          {"leaf_hits", c.leaf_hits},
          {"leaf_triangles", c.leaf_triangles},
          {"box_tests", c.box_tests},
          {"triangle_tests", c.triangle_tests}};
}

/// A ray, or a search of a local tree, by who answered it.
Json ways(const AcceleratorCounters& c) {
  return {{"covered", c.covered},
          {"columns", c.columns},
          {"cones", c.cones},
          {"local_searches", c.local_searches},
          {"global_searches", c.global_searches}};
}

Json checked_json(const CheckedAnswers& checked) {
  Json rows = Json::array();
  for (const CheckedQuestion& q : checked.questions) {
    Json row{{"question", name(q.question)}};
    row.update(ways(q.counters));
    row["differences"] = q.differences;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string checked_text(const CheckedAnswers& checked) {
  std::string text = "\nsearches by way (a ray may take several), checked by brute force\n";
  text += fmt::format("{:<24} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12}\n", "question", "coverage", "columns", "cones",
                      "other local", "global", "differences");
  for (const CheckedQuestion& q : checked.questions) {
    const AcceleratorCounters& c = q.counters;
    text += fmt::format("{:<24} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12}\n", name(q.question), c.covered, c.columns,
                        c.cones, c.local_searches - c.columns - c.cones, c.global_searches, q.differences);
  }
  return text;
}

}  // namespace

std::string trace_json(const Traced& traced, const Scene& scene, unsigned threads) {
  const AcceleratorCounters& c = traced.answers.counters;
  Json report{{"scene", scene.name},
              {"triangles", scene.mesh.triangle_count()},
              {"environment", environment_json(threads)},
              {"rays", traced.rays},
              {"hits", traced.answers.hit_count()},
              {"trace_seconds", traced.answers.seconds},
              {"counters",
               {{"invalid_rays", c.invalid_rays},
                {"covered", c.covered},
                {"columns", c.columns},
                {"cones", c.cones},
                {"areas_tested", c.areas_tested},
                {"areas_serving", c.areas_serving},
                {"local_searches", c.local_searches},
                {"local_hits", c.local_hits},
                {"continued", c.continued},
                {"global_searches", c.global_searches},
                {"local", work(c.local)},
                {"global", work(c.global)}}}};
  if (traced.checked) {
    report["mismatches"] = traced.checked->wrong;
    report["checked"] = checked_json(*traced.checked);
  }
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string trace_text(const Traced& traced, const Scene& scene, size_t areas) {
  const AcceleratorCounters& c = traced.answers.counters;
  std::string text = fmt::format("{}: {} triangles, {} area{}\n", scene.name, scene.mesh.triangle_count(), areas,
                                 areas == 1 ? "" : "s");
  const auto line = [&](const char* name, uint64_t value) { text += fmt::format("  {:<36} {:>12}\n", name, value); };
  line("rays", traced.rays);
  line("hits", traced.answers.hit_count());
  line("invalid rays (misses)", c.invalid_rays);
  line("answered by the coverage of an area", c.covered);
  line("areas asked", c.areas_tested);
  line("areas that serve", c.areas_serving);
  line("searches of local trees", c.local_searches);
  line("... in ray space, as columns", c.columns);
  line("... in ray space, as cones", c.cones);
  line("hits accepted from local trees", c.local_hits);
  line("searches that went on in a next area", c.continued);
  line("searches of the global tree", c.global_searches);
  line("boxes tested", c.local.box_tests + c.global.box_tests);
  line("triangles tested", c.local.triangle_tests + c.global.triangle_tests);
  if (!traced.checked) return text;
  line("differences from brute force", traced.checked->wrong);
  return text + checked_text(*traced.checked);
}

std::string unused_trees_note(const Traced& traced, const std::string& space) {
  const AcceleratorCounters& c = traced.answers.counters;
  if (space.empty() || space == "none" || c.local_searches > 0 || c.covered == 0) return "";
  return fmt::format(
      "No ray reached a tree in {} space: coverage answered {} of {} rays. Add --no-coverage to have the trees "
      "asked.\n",
      space, c.covered, traced.rays);
}

}  // namespace raygrain::cli

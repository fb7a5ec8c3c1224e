// An accelerator's account of itself, in words.
#include <cmath>
#include <cstdio>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"
#include "raygrain/rays.h"

#include "accel/accelerator_parts.h"
#include "base/timer.h"

namespace raygrain {

namespace {

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

double percent(uint64_t part, uint64_t whole) {
  return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

std::string text_of(const AreaReport& area) {
  std::string text = area.name + ": " + area.structures + "\n";
  text += line("  %zu triangles, built in %.3f s, %.1f MB\n", area.triangles, area.build_seconds,
               static_cast<double>(area.memory_bytes) * 1e-6);
  for (size_t from = 0; from < area.routes.size();) {
    const size_t end = area.routes.find('\n', from);
    text += "  " + area.routes.substr(from, end - from) + "\n";
    from = end + 1;
  }
  text += line("  %.0f ns a ray, %.0f ns through the global tree: ", area.area_nanoseconds, area.global_nanoseconds);
  if (std::isinf(area.break_even_rays)) return text + "it saves nothing\n";
  return text + line("pays for its build after %.0f rays\n", area.break_even_rays);
}

/// The least of three runs over the rays.
template <class Trace>
double nanoseconds_per_ray(std::span<const Ray> rays, const Trace& trace) {
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3; ++round) {
    const Timer timer;
    uint32_t sum = 0;  // so that no search is left out
    for (const Ray& ray : rays) sum += trace(ray).triangle;
    const double seconds = timer.seconds() + (sum == 0xfffffffeu ? 1e-12 : 0);
    least = std::min(least, seconds * 1e9 / static_cast<double>(rays.size()));
  }
  return least;
}

std::string cost_text(double nanoseconds) {
  return std::isinf(nanoseconds) ? "none" : line("%.0f", nanoseconds);
}

std::string route_text(const char* kind, const Route& route, std::span<const AreaCosts> costs,
                       WayCosts AreaCosts::*which, double many, size_t area) {
  const bool covers = route.covers[area] != 0, searches = route.searches[area] != 0;
  std::string text = std::string(kind) + ": along it " +
                     (covers     ? "coverage"
                      : searches ? "its tree"
                                 : "global tree") +
                     ", near it " + (searches ? "its tree" : "global tree");
  if (costs.empty()) return text;
  const WayCosts& c = costs[area].*which;
  return text + line(" (predicted ns along it: coverage %s, tree %s, global %s; near it: tree %s, global %s)",
                     cost_text(c.coverage).c_str(), cost_text(c.local).c_str(), cost_text(c.global * many).c_str(),
                     cost_text(c.off_local).c_str(), cost_text(c.off_global * many).c_str());
}

/// A line for each kind of question.
std::string routes_text(const Routes& routes, std::span<const AreaCosts> costs, double many, size_t area) {
  return route_text("any hit", routes.any, costs, &AreaCosts::any, 1, area) + "\n" +
         route_text("closest hit", routes.nearest, costs, &AreaCosts::nearest, 1, area) + "\n" +
         route_text("any hit in arrays", routes.any_of_many, costs, &AreaCosts::any, many, area) + "\n" +
         route_text("closest hit in arrays", routes.nearest_of_many, costs, &AreaCosts::nearest, many, area) + "\n";
}

}  // namespace

void Accelerator::Parts::describe_local(size_t area, AreaReport& report) const {
  const LocalTree& local = locals[area];
  const SearchTree& search = searches[area];
  report.triangles = local.tree->prims.size();
  report.build_seconds += local.build_seconds;
  report.memory_bytes += raygrain::memory_bytes(*local.tree) + search.wide_bytes();
  if (!report.structures.empty()) report.structures += ", ";
  if (const auto& tree = search.in_ray_space())
    report.structures += std::string("tree in ray space (") + raygrain::name(tree->frame().kind) + "), ";
  report.structures += "tree";
}

Explanation Accelerator::explain(const AcceleratorCounters& counters, size_t rays) const {
  if (rays == 0) throw Error(ErrorCode::kUsage, "explain", "0 rays", "Use at least 1");
  Explanation explanation;
  explanation.counters = counters;
  explanation.global_bytes = raygrain::memory_bytes(global_tree()) + parts_->global.wide_bytes();
  for (size_t i = 0; i < parts_->geometries.size(); ++i) {
    const InfluenceArea& area = parts_->geometries[i].area();
    AreaReport report;
    report.name = area.name;
    if (i < parts_->coverages.size() && parts_->coverages[i].is_useful()) {
      report.structures = "coverage";
      report.build_seconds = parts_->coverages[i].build_seconds();
      report.memory_bytes = parts_->coverages[i].memory_bytes();
    }
    if (i < parts_->locals.size()) parts_->describe_local(i, report);
    report.routes = routes_text(parts_->routes, parts_->costs, parts_->many_share, i);
    const std::vector<Ray> sample = cast_rays(AreaRays{area, RayStart::kRandomDepth}, rays, i + 1);
    const double here = nanoseconds_per_ray(sample, [&](const Ray& ray) { return intersect(ray); });
    const double global =
        nanoseconds_per_ray(sample, [&](const Ray& ray) { return parts_->global.intersect(ray, {}, {}, nullptr); });
    report.area_nanoseconds = here;
    report.global_nanoseconds = global;
    report.break_even_rays =
        global > here ? report.build_seconds * 1e9 / (global - here) : std::numeric_limits<double>::infinity();
    explanation.areas.push_back(std::move(report));
  }
  return explanation;
}

std::string to_text(const Explanation& explanation) {
  std::string text;
  for (const AreaReport& area : explanation.areas) text += text_of(area);
  text += line("global tree: %.1f MB\n", static_cast<double>(explanation.global_bytes) * 1e-6);
  const AcceleratorCounters& c = explanation.counters;
  if (c.rays == 0) return text;
  text += line(
      "of %llu rays: %.1f %% answered by coverage, %.1f %% by local trees, %.1f %% needed the global tree, %.1f %% "
      "invalid\n",
      static_cast<unsigned long long>(c.rays), percent(c.covered, c.rays),
      percent(c.rays - c.covered - c.global_searches - c.invalid_rays, c.rays), percent(c.global_searches, c.rays),
      percent(c.invalid_rays, c.rays));
  text += line("local searches in ray space: %llu as columns, %llu as cones, of %llu\n",
               static_cast<unsigned long long>(c.columns), static_cast<unsigned long long>(c.cones),
               static_cast<unsigned long long>(c.local_searches));
  return text;
}

}  // namespace raygrain

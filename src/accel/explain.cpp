// An accelerator's account of itself: measured, counted and summed.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"

#include "accel/accelerator_parts.h"
#include "accel/area_questions.h"
#include "base/text_line.h"
#include "base/timer.h"

namespace raygrain {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr AreaQuestion kQuestions[] = {{true, true}, {false, true}, {true, false}, {false, false}};

/// Nanoseconds a ray of two ways of asking, which take turns: the least of three.
template <class Here, class There>
std::pair<double, double> least_nanoseconds(size_t rays, const Here& here, const There& there) {
  std::pair least{kInfinity, kInfinity};
  const auto timed = [rays](double& best, const auto& ask) {
    const Timer timer;
    ask();
    best = std::min(best, timer.seconds() * 1e9 / static_cast<double>(rays));
  };
  for (int round = 0; round < 3; ++round) {
    timed(least.first, here);
    timed(least.second, there);
  }
  return least;
}

std::string cost_text(double nanoseconds) {
  return std::isinf(nanoseconds) ? "none" : text_line("%.0f", nanoseconds);
}

/// What the choice compared. `share_of_many`: of the global tree's costs, for arrays; coverage answers these in
/// batches.
std::string predictions_text(const WayCosts& costs, const double* share_of_many) {
  if (!costs.has_samples) return " (no rays along it to sample)";
  const double global = share_of_many != nullptr ? *share_of_many : 1;
  const double coverage = share_of_many != nullptr ? kShareOfBatch : 1;
  return text_line(" (predicted ns along it: coverage%s %s, tree %s, global %s; near it: tree %s, global %s)",
                   share_of_many != nullptr ? " in batches" : "", cost_text(costs.coverage * coverage).c_str(),
                   cost_text(costs.local).c_str(), cost_text(costs.global * global).c_str(),
                   cost_text(costs.off_local).c_str(), cost_text(costs.off_global * global).c_str());
}

std::string route_text(const Route& route, size_t area) {
  const bool covers = route.covers[area] != 0, searches = route.searches[area] != 0;
  return std::string(": along it ") +
         (covers     ? "coverage"
          : searches ? "its tree"
                     : "global tree") +
         ", near it " + (searches ? "its tree" : "global tree");
}

/// A line for each kind of question.
std::string routes_text(const Routes& routes, std::span<const AreaCosts> costs, ManyShares many, size_t area) {
  const auto line = [&](const char* kind, const Route& route, WayCosts AreaCosts::*which, const double* share) {
    return kind + route_text(route, area) + (costs.empty() ? "" : predictions_text(costs[area].*which, share)) + "\n";
  };
  return line("any hit", routes.any, &AreaCosts::any, nullptr) +
         line("closest hit", routes.nearest, &AreaCosts::nearest, nullptr) +
         line("any hit in arrays", routes.any_of_many, &AreaCosts::any, &many.any) +
         line("closest hit in arrays", routes.nearest_of_many, &AreaCosts::nearest, &many.nearest);
}

/// An accelerator and its global tree alone, asked about one area.
class Interview {
 public:
  /// `global`: the scene without areas.
  Interview(const Accelerator& scene, const Accelerator& global, const AreaGeometry& geometry, size_t area)
      : scene_(scene), global_(global), geometry_(geometry), area_(area) {}

  std::vector<AreaTimes> ask_all(size_t rays, double build_seconds) const {
    std::vector<AreaTimes> times;
    const AreaQuestions any = questions_of(geometry_, scene_.mesh(), true, rays, area_);
    const AreaQuestions closest = questions_of(geometry_, scene_.mesh(), false, rays, area_);
    for (const AreaQuestion question : kQuestions) {
      const AreaQuestions& asked = question.any ? any : closest;
      if (asked.size() > 0) times.push_back(ask(asked, question.together, build_seconds));
    }
    return times;
  }

 private:
  AreaTimes ask(const AreaQuestions& questions, bool together, double build_seconds) const {
    AreaTimes times{{questions.any, together}, questions.size(), {}, 0, 0, kInfinity};
    AreaAnswers answers(questions.size());
    AcceleratorCounters counters;
    answer(scene_, questions, together, answers, &counters);
    times.use = counters.areas[area_];
    const auto here = [&] { answer(scene_, questions, together, answers, nullptr); };
    const auto there = [&] { answer(global_, questions, together, answers, nullptr); };
    std::tie(times.area_nanoseconds, times.global_nanoseconds) = least_nanoseconds(questions.size(), here, there);
    if (times.use.answered() == 0) return times;  // and never pay, whatever the clock says
    times.break_even_rays = raygrain::break_even_rays(build_seconds, times.area_nanoseconds, times.global_nanoseconds);
    return times;
  }

  void answer(const Accelerator& scene, const AreaQuestions& questions, bool together, AreaAnswers& answers,
              AcceleratorCounters* counters) const {
    if (together)
      ask_together(scene, questions, geometry_.is_plane(), answers, counters);
    else
      ask_one_by_one(scene, questions, answers, counters);
  }

  const Accelerator& scene_;
  const Accelerator& global_;
  const AreaGeometry& geometry_;
  const size_t area_;
};

}  // namespace

void Accelerator::Parts::describe_local(size_t area, AreaReport& report) const {
  const LocalTree& local = locals[area];
  const SearchTree& search = searches[area];
  report.triangles = local.tree->prims.size();
  report.build_seconds += local.build_seconds;
  if (!report.structures.empty()) report.structures += ", ";
  if (const auto& tree = search.in_ray_space())
    report.structures += std::string("tree in ray space (") + raygrain::name(tree->frame().kind) + "), ";
  report.structures += "tree";
}

AreaReport Accelerator::Parts::describe(size_t area) const {
  AreaReport report;
  report.name = geometries[area].area().name;
  if (area < coverages.size() && coverages[area].is_useful()) {
    report.structures = "coverage";
    report.build_seconds = coverages[area].build_seconds();
  }
  if (area < locals.size()) describe_local(area, report);
  report.build_seconds += shared_seconds / static_cast<double>(geometries.size());
  report.routes = routes_text(routes, costs, many_shares, area);
  return report;
}

Explanation Accelerator::explain(const AcceleratorCounters& counters, size_t rays) const {
  const size_t count = parts_->geometries.size();
  if (rays == 0) throw Error(ErrorCode::kUsage, "explain", "0 rays", "Use at least 1");
  if (!counters.areas.empty() && counters.areas.size() != count)
    throw Error(
        ErrorCode::kUsage, "explain",
        "counters of " + std::to_string(counters.areas.size()) + " areas, but there are " + std::to_string(count),
        "Pass counters of this accelerator");
  const AcceleratorMemory memory = parts_->memory();
  const Accelerator global = with_local_trees({});
  Explanation explanation;
  explanation.counters = counters;
  explanation.global_bytes = memory.global;
  explanation.shared_bytes = memory.shared;
  for (size_t i = 0; i < count; ++i) {
    AreaReport report = parts_->describe(i);
    report.memory_bytes = memory.areas[i];
    if (!report.structures.empty())
      report.times = Interview(*this, global, parts_->geometries[i], i).ask_all(rays, report.build_seconds);
    if (!counters.areas.empty()) report.use = counters.areas[i];
    if (counters.rays > 0)
      report.share = static_cast<double>(report.use.answered()) / static_cast<double>(counters.rays);
    explanation.areas.push_back(std::move(report));
  }
  return explanation;
}

double break_even_rays(double build_seconds, double area_nanoseconds, double global_nanoseconds) {
  const double saved = global_nanoseconds - area_nanoseconds;
  const double rays = build_seconds * 1e9 / saved;
  return saved > 0 && build_seconds >= 0 && !std::isnan(rays) ? rays : kInfinity;
}

}  // namespace raygrain

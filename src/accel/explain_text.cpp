// An accelerator's account of itself, in words.
#include <algorithm>
#include <cmath>

#include "raygrain/accelerator.h"

#include "base/quantity_text.h"
#include "base/text_line.h"

namespace raygrain {

namespace {

double percent(uint64_t part, uint64_t whole) {
  return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

std::string size_text(size_t bytes) {
  return bytes_text(static_cast<double>(bytes));
}

std::string who_answered(const AreaUse& use, uint64_t rays) {
  return text_line("%.0f %% answered by coverage, %.0f %% by its tree", percent(use.covered, rays),
                   percent(use.local, rays));
}

std::string text_of(const AreaTimes& times) {
  const std::string question(name(times.question));
  if (times.use.answered() == 0)
    return text_line("  left to the global tree: %s (%.0f ns a ray, %.0f ns without areas)\n", question.c_str(),
                     times.area_nanoseconds, times.global_nanoseconds);
  const std::string measured = text_line(" (%.0f ns a ray, %.0f ns through the global tree; ", times.area_nanoseconds,
                                         times.global_nanoseconds) +
                               who_answered(times.use, times.rays) + ")\n";
  if (std::isinf(times.break_even_rays)) return "  saves nothing: " + question + measured;
  return "  pays after about " + rough_count_text(times.break_even_rays) + " rays: " + question + measured;
}

std::string text_of(const AreaReport& area, uint64_t counted) {
  std::string text = area.name + ": " + (area.structures.empty() ? "no structures" : area.structures) + "\n";
  std::vector<AreaTimes> times = area.times;
  std::ranges::stable_sort(times, [](const AreaTimes& a, const AreaTimes& b) {
    return std::pair(a.break_even_rays, a.use.answered() == 0) < std::pair(b.break_even_rays, b.use.answered() == 0);
  });
  for (const AreaTimes& t : times) text += text_of(t);
  if (const std::string_view missing = missing_times(area); !missing.empty())
    text += "  " + std::string(missing) + "\n";
  text += text_line("  built in %.3f s (timed once), ", area.build_seconds) + size_text(area.memory_bytes);
  text += area.triangles > 0 ? text_line(", %zu triangles in its tree\n", area.triangles) : "\n";
  for (size_t from = 0; from < area.routes.size();) {
    const size_t end = area.routes.find('\n', from);
    text += "  " + area.routes.substr(from, end - from) + "\n";
    from = end + 1;
  }
  if (counted == 0) return text;
  return text + "  of the counted rays: " + who_answered(area.use, counted) +
         text_line("; %.0f %% were its own and went to the global tree\n", percent(area.use.global, counted));
}

}  // namespace

std::string_view name(AreaQuestion question) {
  if (question.together) return question.any ? "any hits together" : "closest hits together";
  return question.any ? "any hits one by one" : "closest hits one by one";
}

std::string_view missing_times(const AreaReport& area) {
  const auto is_any = [](const AreaTimes& times) { return times.question.any; };
  if (area.times.empty() || std::ranges::any_of(area.times, is_any)) return "";
  return "no any-hit rays found: none of those tried from surfaces is its own";
}

std::string to_text(const Explanation& explanation) {
  std::string text;
  const AcceleratorCounters& c = explanation.counters;
  for (const AreaReport& area : explanation.areas) text += text_of(area, c.rays);
  text += "global tree: " + size_text(explanation.global_bytes) +
          "; shared by the areas: " + size_text(explanation.shared_bytes) + "\n";
  if (c.rays == 0) return text;
  text += text_line(
      "of %llu rays: %.1f %% answered by coverage, %.1f %% by local trees, %.1f %% needed the global tree, %.1f %% "
      "invalid\n",
      static_cast<unsigned long long>(c.rays), percent(c.covered, c.rays),
      percent(c.rays - c.covered - c.global_searches - c.invalid_rays, c.rays), percent(c.global_searches, c.rays),
      percent(c.invalid_rays, c.rays));
  text += text_line("local searches in ray space: %llu as columns, %llu as cones, of %llu\n",
                    static_cast<unsigned long long>(c.columns), static_cast<unsigned long long>(c.cones),
                    static_cast<unsigned long long>(c.local_searches));
  return text;
}

}  // namespace raygrain

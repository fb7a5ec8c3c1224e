// An accelerator's account of itself, in words.
#include <cmath>
#include <cstdio>

#include "raygrain/accelerator.h"

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
  text += line("  %.0f ns a ray, %.0f ns through the global tree: ", area.area_nanoseconds, area.global_nanoseconds);
  if (std::isinf(area.break_even_rays)) return text + "it saves nothing\n";
  return text + line("pays for its build after %.0f rays\n", area.break_even_rays);
}

}  // namespace

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

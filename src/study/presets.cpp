// The ready-made studies by name; "Ray Distribution Aware Heuristics for Bounding Volume Hierarchies Construction in
// Ray Tracing" (2024), section 9, and what it left open.
#include "study/presets.h"

#include <functional>

#include "raygrain/error.h"

#include "base/nearest_name.h"
#include "study/sources.h"

namespace raygrain {
namespace {

struct Preset {
  const char* name;
  const char* description;
  StudyGrid (*grid)(const StudySources&);
  Study (*make)(const StudySources&);
};

constexpr Preset kPresets[] = {
    {"paper", "the 256 tests as the paper describes them, sound", study::paper_grid, nullptr},
    {"published", "the 256 tests with the rules of the published runs", study::published_grid, nullptr},
    {"corrected", "equal thresholds, all axes, matched rays, other builders: what really pays", study::corrected_grid,
     nullptr},
    {"parameters", "table 2, and finer: thresholds, bins, levels", study::parameters_grid, nullptr},
    {"areas", "octree against list for 1 to 256 areas", nullptr, study::areas_study},
    {"memory", "section 9.6, counted as the paper does and measured", nullptr, study::memory_study},
    {"scaling", "cost and build time from 1,000 to 4 million triangles", study::scaling_grid, nullptr},
    {"stress", "several areas at once, foreign rays, break-even hit ratios", nullptr, study::stress_study},
    {"visibility", "trees that know where rays end: splits, reinsertion, wide forms", nullptr, study::visibility_study},
};

const Preset& find_preset(const std::string& name) {
  std::vector<std::string_view> names;
  for (const Preset& preset : kPresets) {
    if (name == preset.name) return preset;
    names.emplace_back(preset.name);
  }
  throw Error(ErrorCode::kUsage, name, "is no study", suggestion(name, names));
}

}  // namespace

std::vector<StudyPreset> study_presets() {
  std::vector<StudyPreset> presets;
  for (const Preset& preset : kPresets) presets.push_back({preset.name, preset.description});
  return presets;
}

StudyGrid preset_grid(const std::string& name, const StudySources& sources) {
  const Preset& preset = find_preset(name);
  if (preset.grid == nullptr)
    throw Error(ErrorCode::kUsage, name, "is no grid of trees",
                "paper, published, corrected, parameters and scaling are");
  return preset.grid(sources);
}

Study preset_study(const std::string& name, const StudySources& sources) {
  const Preset& preset = find_preset(name);
  return preset.grid != nullptr ? make_study(preset.grid(sources)) : preset.make(sources);
}

}  // namespace raygrain

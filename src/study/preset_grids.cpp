// The studies that are grids of trees: paper, corrected, parameters.
#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

#include "study/presets.h"
#include "study/sources.h"

namespace raygrain::study {
namespace {

constexpr float kPaperThreshold = 0.4f;     // Table 1 of the paper
constexpr float kPublishedLongest = 0.99f;  // of the published rows with LSPH, which the paper does not list

StudyGrid base_grid(const char* name, const StudySources& sources, const std::vector<StudyScene>& extra = {}) {
  StudyGrid grid;
  grid.name = name;
  grid.scenes = paper_scenes(sources, grid.missing, extra);
  for (const StudyScene& scene : extra)
    if (is_wanted(sources, scene.name)) grid.scenes.push_back(scene);
  if (sources.quick)
    for (StudyScene& scene : grid.scenes)
      std::erase_if(scene.areas, [&](const StudyArea& area) {
        return scene.areas.size() > 2 && area.variant != "parallel" && area.variant != "oblique";
      });
  grid.rays = {{"matched", PointSpread::kNearPlane, sources.rays}};
  grid.seeds = {sources.seed};
  return grid;
}

StudyRecipe recipe(const char* text, const StudyGrid& grid, const char* setting = "") {
  return {text, setting, parse_recipe(text, grid.registry)};
}

StudyRecipe with_threshold(StudyRecipe row, float threshold) {
  row.recipe.parameters.split_plane_quality_threshold = threshold;
  row.setting = fmt::format("quality {}", threshold);
  return row;
}

StudyRecipe reinserted(StudyRecipe row) {
  row.setting = "reinsertion";
  row.reinsert = true;
  return row;
}

StudyRecipe in_frame(StudyRecipe row) {
  row.setting = "in frame";
  row.in_frame = true;
  return row;
}

StudyRecipe visible(StudyRecipe row) {
  row.setting = "visibility";
  row.visible = true;
  return row;
}

constexpr std::array kCombos{"PAH+SPFH", "PAH+LSPH", "SAH+SPFH", "SAH+LSPH"};

StudyRecipe with_parameters(const StudyGrid& grid, float quality, float acceptable, float excellent) {
  StudyRecipe row = recipe("PAH+SPFH", grid);
  row.recipe.parameters.split_plane_quality_threshold = quality;
  row.recipe.parameters.acceptable_ratio = acceptable;
  row.recipe.parameters.excellent_ratio = excellent;
  row.setting = fmt::format("quality {} acceptable {} excellent {}", quality, acceptable, excellent);
  return row;
}

/// The three thresholds, each with each.
void add_fine_grid(StudyGrid& grid) {
  for (const float quality : {0.1f, 0.2f, 0.4f, 0.6f, 0.8f})
    for (const float acceptable : {1.1f, 1.3f, 1.5f})
      for (const float excellent : {0.7f, 0.9f, 1.1f}) {
        const StudyRecipe row = with_parameters(grid, quality, acceptable, excellent);
        const auto same = [&](const StudyRecipe& other) { return other.setting == row.setting; };
        if (std::none_of(grid.recipes.begin(), grid.recipes.end(), same)) grid.recipes.push_back(row);
      }
  for (const uint32_t bins : {8u, 16u, 32u, 64u, 128u}) {
    StudyRecipe row = recipe("PAH+SPFH", grid);
    row.recipe.parameters.bins = bins;
    row.setting = fmt::format("bins {}", bins);
    grid.recipes.push_back(row);
  }
  for (const uint32_t levels : {0u, 2u, 4u, 6u, 8u, 10u, 15u}) {
    StudyRecipe row = recipe("PAH+SPFH", grid);
    row.recipe.parameters.max_non_fallback_levels = levels;
    row.setting = fmt::format("levels {}", levels);
    grid.recipes.push_back(row);
  }
}

/// What is measured with rays uniform in angle, too, as the published runs drew them.
bool is_core(const StudyRecipe& row) {
  return row.setting.empty() && !row.recipe.orientation.empty() && row.recipe.builder == "paper";
}

}  // namespace

StudyGrid paper_grid(const StudySources& sources) {
  StudyGrid grid = base_grid("paper", sources);
  for (const char* combo : kCombos) grid.recipes.push_back(recipe(combo, grid));
  return grid;
}

StudyGrid corrected_grid(const StudySources& sources) {
  StudyGrid grid =
      base_grid("corrected", sources,
                {procedural_scene("procedural:city", "City"), procedural_scene("procedural:forest", "Forest"),
                 procedural_scene("procedural:terrain", "Terrain")});
  grid.rays.push_back({"angular", PointSpread::kAngle, sources.rays});
  for (const char* combo : kCombos) grid.recipes.push_back(recipe(combo, grid));
  for (const char* combo : {"PAH+LSPH", "SAH+LSPH"})
    grid.recipes.push_back(with_threshold(recipe(combo, grid), kPublishedLongest));
  for (const char* combo : {"SAH+ALL", "PAH+ALL", "SAH+ALL@binned", "PAH+ALL@binned", "SAH+ALL@sweep", "PAH+ALL@sweep",
                            "SAH+ALL@spatial", "PAH+ALL@spatial", "SAMPLED+ALL@binned"})
    grid.recipes.push_back(recipe(combo, grid));
  for (const char* combo : {"SAH+ALL@binned", "PAH+ALL@binned"})
    grid.recipes.push_back(reinserted(recipe(combo, grid)));
  for (const char* combo : {"PAH+ALL@binned", "PAH+ALL@spatial"}) grid.recipes.push_back(in_frame(recipe(combo, grid)));
  grid.recipes.push_back(visible(recipe("SAMPLED+ALL@binned", grid)));
  grid.recipes.push_back(recipe("VISIBLE+ALL@binned", grid));
  grid.leave_out = [](const StudyScene& scene, const StudyArea& area, const StudyRecipe& row, const StudyRays& rays) {
    const bool is_plane = std::holds_alternative<PlaneArea>(area.area.shape);
    if (rays.spread == PointSpread::kAngle && (is_plane || !is_core(row))) return true;
    const bool is_half = area.variant == "15deg" || area.variant == "45deg";
    // A thousand sample rays for each of millions of boxes take minutes.
    const bool is_sampled = row.recipe.measure == "SAMPLED";
    return is_large(scene) && (rays.spread == PointSpread::kAngle || is_sampled || (is_half && !is_core(row)));
  };
  return grid;
}

StudyGrid parameters_grid(const StudySources& sources) {
  StudyGrid grid = base_grid("parameters", sources);
  grid.recipes = {with_parameters(grid, kPaperThreshold, 1.3f, 0.9f), with_parameters(grid, 0.1f, 1.3f, 0.9f),
                  with_parameters(grid, 0.8f, 1.3f, 0.9f), with_parameters(grid, kPaperThreshold, 1.1f, 0.7f),
                  with_parameters(grid, kPaperThreshold, 1.5f, 1.1f)};
  const size_t table = grid.recipes.size();
  if (sources.quick) return grid;
  add_fine_grid(grid);
  std::vector<std::string> of_table;
  for (size_t i = 0; i < table; ++i) of_table.push_back(grid.recipes[i].setting);
  grid.leave_out = [of_table](const StudyScene& scene, const StudyArea&, const StudyRecipe& row, const StudyRays&) {
    return is_large(scene) && std::find(of_table.begin(), of_table.end(), row.setting) == of_table.end();
  };
  return grid;
}

StudyGrid scaling_grid(const StudySources& sources) {
  constexpr uint32_t kSizes[] = {1, 2, 4, 8, 15, 30, 48, 95};  // about 440 triangles times the square
  constexpr uint32_t kSmallestSeed = 16;                       // of one building: 972 triangles
  constexpr double kLongest = 1100;                            // thousand triangles, for all but the fast builders
  StudyGrid grid;
  grid.name = "scaling";
  const std::span<const uint32_t> sizes = std::span(kSizes).first(sources.quick ? 3 : std::size(kSizes));
  std::vector<std::string> names;
  for (const uint32_t size : sizes) names.push_back(fmt::format("City {}", size));
  check_wanted(sources, {names.begin(), names.end()});
  for (const uint32_t size : sizes) {
    const std::string name = fmt::format("City {}", size);
    if (is_wanted(sources, name))
      grid.scenes.push_back(
          procedural_scene(fmt::format("procedural:city?size={}&seed={}", size, size == 1 ? kSmallestSeed : 1), name));
  }
  for (const char* combo : {"SAH+LSPH", "PAH+SPFH", "SAH+ALL@binned", "PAH+ALL@binned", "SAH+ALL@subset",
                            "PAH+ALL@subset", "SAH+ALL@spatial", "PAH+ALL@spatial"})
    grid.recipes.push_back(recipe(combo, grid));
  grid.rays = {{"matched", PointSpread::kNearPlane, sources.rays}};
  grid.seeds = {sources.seed};
  grid.global = {"SAH", "ALL", "subset", {}};
  grid.leave_out = [](const StudyScene& scene, const StudyArea&, const StudyRecipe& row, const StudyRays&) {
    return scene.weight > kLongest && row.recipe.builder != "binned" && row.recipe.builder != "subset";
  };
  return grid;
}

}  // namespace raygrain::study

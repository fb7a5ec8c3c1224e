#include "raygrain/registry.h"

#include <algorithm>

#include "raygrain/error.h"

#include "base/nearest_name.h"

namespace raygrain {

namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = lower(c);
  return result;
}

/// "Did you mean PAH? Known: SAH, PAH, ...".
template <class Entry>
std::string hint_for(std::string_view name, const std::vector<Entry>& entries) {
  std::vector<std::string_view> names;
  names.reserve(entries.size());
  for (const Entry& entry : entries) names.push_back(entry.name);
  const std::string_view near = nearest_name(name, names);
  return (near.empty() ? "" : "Did you mean " + std::string(near) + "? ") + known_names(names);
}

template <class Entry>
const Entry& find_entry(const std::vector<Entry>& entries, std::string_view name, const char* kind) {
  const std::string wanted = lower(name);
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return lower(entry.name) == wanted; });
  if (found != entries.end()) return *found;
  throw Error(ErrorCode::kUsage, kind, "unknown name \"" + std::string(name.substr(0, 64)) + "\"",
              hint_for(name, entries));
}

RayMeasure make_directional(const HeuristicInput& input) {
  if (const auto* plane = std::get_if<PlaneArea>(&input.area->shape)) return directional_measure(plane->direction);
  throw Error(ErrorCode::kUsage, "DIR", "area \"" + input.area->name + "\" is a point area; DIR needs parallel rays",
              "use PAH, or a plane area");
}

RayMeasure make_visible(const HeuristicInput& input) {
  return visible_measure(
      input.area != nullptr ? projected_area_measure(*input.area, Culling::kWindow) : surface_area_measure(),
      input.samples);
}

std::vector<MeasureEntry> default_measures() {
  return {
      {"SAH", "surface area: rays from everywhere", false, false,
       [](const HeuristicInput&) { return surface_area_measure(); }},
      {"PAH", "projected area, culled to the area's window", true, false,
       [](const HeuristicInput& input) { return projected_area_measure(*input.area, Culling::kWindow); }},
      {"PAH-UNCULLED", "projected area, not culled", true, false,
       [](const HeuristicInput& input) { return projected_area_measure(*input.area, Culling::kNone); }},
      {"DIR", "projected area along one direction as three face weights", true, false, make_directional},
      {"SOLID", "solid angle at the eye, culled to the area's window; for a plane area projected area", true, false,
       [](const HeuristicInput& input) { return solid_angle_measure(*input.area, Culling::kWindow); }},
      {"SAMPLED", "sample rays that meet the box", false, true,
       [](const HeuristicInput& input) { return sampled_measure(input.samples); }},
      {"VISIBLE", "projected area (without an area: surface area), weighted by the share of sample rays alive there",
       false, true, make_visible, true},
  };
}

std::vector<OrientationEntry> default_orientations() {
  return {
      {"LSPH", "longest axis first", false, false, [](const HeuristicInput&) { return longest_axis_orientation(); }},
      {"SPFH", "the plane that faces the rays least first", true, false,
       [](const HeuristicInput& input) { return facing_orientation(*input.area); }},
      {"ALL", "every axis", false, true, [](const HeuristicInput&) { return all_axes_orientation(); }},
      {"ROBIN", "one axis after the other", false, false,
       [](const HeuristicInput&) { return round_robin_orientation(); }},
  };
}

const MeasureEntry& measure_of(const Recipe& recipe, const Registry& registry) {
  return find_entry(registry.measures, recipe.measure, "measure");
}
const OrientationEntry& orientation_of(const Recipe& recipe, const Registry& registry) {
  return find_entry(registry.orientations, recipe.orientation, "orientation");
}

void check_supply(const Recipe& recipe, const Registry& registry, const HeuristicInput& input) {
  if (needs_area(recipe, registry) && !input.area)
    throw Error(ErrorCode::kUsage, recipe_name(recipe), "needs an influence area and there is none",
                "name an area, or use SAH with LSPH or ALL");
  if (needs_samples(recipe, registry) && input.samples.empty())
    throw Error(ErrorCode::kUsage, recipe_name(recipe), "needs sample rays and there are none", "give a ray set");
}

}  // namespace

Registry default_registry() {
  return {default_measures(),
          default_orientations(),
          {{"paper", "Algorithm 1 of the paper", build_paper, Centres::kBarycentre},
           {"binned", "binned top-down, all axes, parallel", build_binned, Centres::kBox},
           {"sweep", "full sweep, all axes: the reference for quality", build_sweep, Centres::kBox},
           {"spatial", "binned top-down with planes that cut triangles, parallel", build_spatial, Centres::kBox},
           {"subset", "binned from a random subset: fast, parallel", build_subset, Centres::kBox}}};
}

const char* builder_name(Quality quality) {
  return quality == Quality::kFast ? "subset" : (quality == Quality::kBalanced ? "binned" : "spatial");
}

void set_quality(Recipe& recipe, Quality quality) {
  recipe.builder = builder_name(quality);
  recipe.for_wide = true;
  if (quality != Quality::kFast || lower(recipe.orientation) != "all") return;
  recipe.orientation = "LSPH";
  recipe.parameters.split_plane_quality_threshold = 1;
}

Quality parse_quality(std::string_view text) {
  if (text == "fast") return Quality::kFast;
  if (text == "balanced") return Quality::kBalanced;
  if (text == "best") return Quality::kBest;
  throw Error(ErrorCode::kUsage, "quality", "unknown quality \"" + std::string(text.substr(0, 64)) + "\"",
              "Known: fast, balanced, best");
}

std::string recipe_name(const Recipe& recipe) {
  const std::string name = recipe.measure + "+" + recipe.orientation;
  return lower(recipe.builder) == "paper" ? name : name + "@" + recipe.builder;
}

Recipe parse_recipe(std::string_view text, const Registry& registry) {
  const size_t at = std::min(text.find('@'), text.size());
  const std::string_view heuristic = text.substr(0, at);
  const size_t plus = heuristic.find('+');
  if (plus == std::string_view::npos)
    throw Error(ErrorCode::kUsage, "recipe", "\"" + std::string(text.substr(0, 64)) + "\" is no recipe",
                "write MEASURE+ORIENTATION or MEASURE+ORIENTATION@BUILDER. " + hint_for(heuristic, registry.measures));
  Recipe recipe;
  recipe.measure = find_entry(registry.measures, heuristic.substr(0, plus), "measure").name;
  recipe.orientation = find_entry(registry.orientations, heuristic.substr(plus + 1), "orientation").name;
  if (at < text.size()) recipe.builder = find_entry(registry.builders, text.substr(at + 1), "builder").name;
  return recipe;
}

bool needs_area(const Recipe& recipe, const Registry& registry) {
  return measure_of(recipe, registry).needs_area || orientation_of(recipe, registry).needs_area;
}

bool needs_samples(const Recipe& recipe, const Registry& registry) {
  return measure_of(recipe, registry).needs_samples;
}

bool needs_hits(const Recipe& recipe, const Registry& registry) {
  return measure_of(recipe, registry).needs_hits;
}

bool needs_centroids(const Recipe& recipe, const Registry& registry) {
  return find_entry(registry.builders, recipe.builder, "builder").centres == Centres::kBarycentre;
}

BuildOptions make_build_options(const Recipe& recipe, const Registry& registry, const HeuristicInput& input) {
  check_supply(recipe, registry, input);
  const OrientationEntry& orientation = orientation_of(recipe, registry);
  BuildOptions options;
  options.strategy.measure = measure_of(recipe, registry).make(input);
  options.strategy.orientation = orientation.make(input);
  options.fallback = BuildStrategy{};
  options.fallback->measure = surface_area_measure();
  options.fallback->orientation = longest_axis_orientation();
  options.parameters = recipe.parameters;
  options.merge_leaves = true;
  if (recipe.for_wide) {
    options.parameters.bins = 32;
    options.rare_leaf_size = 8;
  }
  options.clip = input.clip;
  if (orientation.all_axes) {
    options.parameters.split_plane_quality_threshold = 0;
    options.parameters.excellent_ratio = 0;
  }
  return options;
}

Bvh build_tree(const Recipe& recipe, const Registry& registry, const HeuristicInput& input,
               std::span<const Bounds> bounds, std::span<const Vec3> centroids, BuildLog* log, const BuildRun& run) {
  const BuilderEntry& builder = find_entry(registry.builders, recipe.builder, "builder");
  BuildOptions options = make_build_options(recipe, registry, input);
  options.threads = run.threads;
  options.progress = run.progress;
  if (builder.centres == Centres::kBox) centroids = {};
  return builder.build(bounds, centroids, options, log);
}

}  // namespace raygrain

// Grids of experiments as JSON files: format raygrain-study.
#include <array>
#include <filesystem>
#include <iterator>
#include <utility>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "io/json_reader.h"
#include "io/json_value.h"
#include "io/scene_json.h"
#include "io/text.h"
#include "study/names.h"
#include "study/sources.h"

namespace raygrain {
namespace {

using Keys = std::vector<std::string_view>;
constexpr uint64_t kMost = 1'000'000'000, kMostRepeats = 1'000'000;

void check_format(const JsonReader& file) {
  if (file.at("format").text() != "raygrain-study")
    file.at("format").fail(ErrorCode::kUnsupported, "is not \"raygrain-study\"");
  if (file.at("version").whole_number(0, UINT32_MAX) != 1)
    file.at("version").fail(ErrorCode::kUnsupported, "is a version that this raygrain does not know", "It knows 1");
}

uint64_t whole_or(const JsonReader& object, std::string_view key, uint64_t least, uint64_t otherwise) {
  const auto value = object.find(key);
  return value ? value->whole_number(least, kMost) : otherwise;
}

/// A name of rows, heuristics or the study.
const std::string& name_in(const JsonReader& text) {
  if (!study::is_plain_name(text.text()))
    text.fail(ErrorCode::kMalformed, "has control characters", "Names are one line of text");
  return text.text();
}

bool flag_or(const JsonReader& object, std::string_view key) {
  const auto value = object.find(key);
  return value && value->whole_number(0, 1) == 1;
}

/// {"paper": "Wood"} or {"paper": "all"}.
std::vector<StudyScene> read_paper_scenes(const JsonReader& item, const StudySources& sources,
                                          std::vector<std::string>& missing) {
  item.expect_keys(Keys{"paper"});
  StudySources own = sources;
  own.only.clear();
  if (const std::string& name = item.at("paper").text(); name != "all") own.only = {name};
  std::vector<std::string> lines;
  std::vector<StudyScene> scenes = item.at("paper").with_place([&] { return study::paper_scenes(own, lines); });
  for (const std::string& line : lines)
    if (study::is_wanted(sources, line.substr(0, line.find(':')))) missing.push_back(line);
  return scenes;
}

/// Where a mesh is: beside the file, or in the folder of scenes.
std::string find_mesh(const JsonReader& name, const StudySources& sources) {
  const std::string& text = name.text();
  if (text.starts_with("procedural:")) return text;
  const std::filesystem::path beside = std::filesystem::path(name.path()).parent_path() / text;
  if (std::filesystem::exists(beside)) return beside.string();
  const std::filesystem::path shared = std::filesystem::path(sources.scenes) / text;
  if (!sources.scenes.empty() && std::filesystem::exists(shared)) return shared.string();
  name.fail(ErrorCode::kNotFound, in_quotes(text) + " is neither beside this file nor in the folder of scenes",
            "Name that folder with --scenes");
}

/// {"scene": "procedural:city", "name": "City", "scale": 1, "areas": [...]}; without areas the scene's own.
StudyScene read_own_scene(const JsonReader& item, const StudySources& sources) {
  item.expect_keys(Keys{"scene", "name", "scale", "areas"});
  const std::string path = find_mesh(item.at("scene"), sources);
  const float scale = item.number_or("scale", 1);
  if (!(scale > 0)) item.at("scale").fail(ErrorCode::kMalformed, "must be positive");
  const Scene scene = item.at("scene").with_place([&] { return load_scene(path); });
  StudyScene result{scene.name,
                    [path, scale] { return study::load_scaled(path, scale); },
                    {},
                    static_cast<double>(scene.mesh.triangle_count()) / 1000};
  result.content = study::content_of(scene.mesh);
  if (const auto name = item.find("name")) result.name = name_in(*name);
  std::vector<InfluenceArea> areas = scene.areas;
  if (const auto own = item.find("areas"))
    areas = read_areas(*own, [&] { return mesh_bounds(study::load_scaled(path, scale)); });
  if (areas.empty()) item.fail(ErrorCode::kMalformed, "has no areas", "Add \"areas\", as in scene.json");
  for (const InfluenceArea& area : areas) result.areas.push_back({area.name, area});
  return result;
}

void read_parameters(const JsonReader& object, PaperParameters& p) {
  object.expect_keys(Keys{"max_leaf_cost", "max_leaf_area", "max_leaf_hit_probability", "max_triangles_per_leaf",
                          "max_levels", "bins", "max_non_fallback_levels", "split_plane_quality_threshold",
                          "acceptable_ratio", "excellent_ratio"});
  const auto whole = [&](std::string_view key, uint32_t value) {
    return static_cast<uint32_t>(whole_or(object, key, 0, value));
  };
  p.max_leaf_cost = object.number_or("max_leaf_cost", p.max_leaf_cost);
  p.max_leaf_area = object.number_or("max_leaf_area", p.max_leaf_area);
  p.max_leaf_hit_probability = object.number_or("max_leaf_hit_probability", p.max_leaf_hit_probability);
  p.max_triangles_per_leaf = whole("max_triangles_per_leaf", p.max_triangles_per_leaf);
  p.max_levels = whole("max_levels", p.max_levels);
  p.bins = whole("bins", p.bins);
  p.max_non_fallback_levels = whole("max_non_fallback_levels", p.max_non_fallback_levels);
  p.split_plane_quality_threshold = object.number_or("split_plane_quality_threshold", p.split_plane_quality_threshold);
  p.acceptable_ratio = object.number_or("acceptable_ratio", p.acceptable_ratio);
  p.excellent_ratio = object.number_or("excellent_ratio", p.excellent_ratio);
  BuildOptions options;
  options.parameters = p;
  try {
    validate(options);
  } catch (const Error& error) {
    object.at(error.where).fail(ErrorCode::kMalformed, "is out of range", error.hint);
  }
}

/// "PAH+ALL", or {"recipe": "PAH+ALL", "name": ..., "setting": ..., "parameters": {...}, "reinsert": 1}.
StudyRecipe read_recipe(const JsonReader& item, const Registry& registry) {
  const auto parsed = [&](const JsonReader& text) {
    return text.with_place([&] { return parse_recipe(text.text(), registry); });
  };
  if (item.is_text()) return {recipe_name(parsed(item)), "", parsed(item)};
  item.expect_keys(Keys{"recipe", "name", "setting", "parameters", "reinsert", "in_frame", "visible"});
  StudyRecipe row{"", "", parsed(item.at("recipe"))};
  row.combo = item.has("name") ? name_in(item.at("name")) : recipe_name(row.recipe);
  if (const auto setting = item.find("setting")) row.setting = name_in(*setting);
  if (const auto parameters = item.find("parameters")) read_parameters(*parameters, row.recipe.parameters);
  row.reinsert = flag_or(item, "reinsert");
  row.in_frame = flag_or(item, "in_frame");
  row.visible = flag_or(item, "visible");
  return row;
}

/// {"name": "matched", "spread": "near_plane" | "angle", "count": 1000}.
StudyRays read_rays(const JsonReader& item, const StudySources& sources) {
  item.expect_keys(Keys{"name", "spread", "count"});
  StudyRays rays;
  rays.count = whole_or(item, "count", 1, sources.rays);
  constexpr std::array<std::string_view, 2> kSpreads{"near_plane", "angle"};
  if (const auto spread = item.find("spread"))
    rays.spread = spread->choice(kSpreads) == 0 ? PointSpread::kNearPlane : PointSpread::kAngle;
  rays.name =
      item.has("name") ? name_in(item.at("name")) : (rays.spread == PointSpread::kNearPlane ? "matched" : "angular");
  return rays;
}

/// {"name": "MINE", "face_weights": [x, y, z]}: a measure of one's own.
MeasureEntry read_measure(const JsonReader& item, const Registry& registry) {
  item.expect_keys(Keys{"name", "face_weights"});
  const Vec3 weights = item.at("face_weights").vector();
  if (!(weights.x >= 0 && weights.y >= 0 && weights.z >= 0))
    item.at("face_weights").fail(ErrorCode::kMalformed, "must not be negative");
  if (weights == Vec3{})
    item.at("face_weights").fail(ErrorCode::kMalformed, "are all 0: every tree would cost nothing", "Weigh a face");
  const std::string& name = name_in(item.at("name"));
  if (study::is_known_name(registry.measures, name))
    item.at("name").fail(ErrorCode::kMalformed, in_quotes(name) + " is the name of a measure that there is already",
                         "Choose another one");
  if (name.find_first_of("+@, ") != std::string::npos)
    item.at("name").fail(ErrorCode::kMalformed, in_quotes(name) + " cannot stand in a recipe",
                         "Leave out spaces and + @ ,");
  return {name, "face weights of a study", false, false,
          [weights](const HeuristicInput&) { return face_weight_measure(weights); }};
}

void read_scenes(const JsonReader& file, const StudySources& sources, StudyGrid& grid) {
  for (const JsonReader& item : file.at("scenes").items()) {
    const bool is_paper = item.one_of(std::array<std::string_view, 2>{"paper", "scene"}) == "paper";
    std::vector<StudyScene> scenes = is_paper ? read_paper_scenes(item, sources, grid.missing)
                                              : std::vector<StudyScene>{read_own_scene(item, sources)};
    std::move(scenes.begin(), scenes.end(), std::back_inserter(grid.scenes));
  }
}

StudyGrid read_grid(const std::string& path, const StudySources& sources) {
  const std::string text = read_whole_file(path);
  const JsonValue value = parse_json(path, text);
  const JsonReader file(value, path);
  file.expect_keys(
      Keys{"format", "version", "name", "scenes", "recipes", "rays", "seeds", "repeats", "global", "measures"});
  check_format(file);
  StudyGrid grid;
  grid.name = name_in(file.at("name"));
  grid.source = text;
  if (const auto measures = file.find("measures"))
    for (const JsonReader& item : measures->items())
      grid.registry.measures.push_back(read_measure(item, grid.registry));
  read_scenes(file, sources, grid);
  for (const JsonReader& item : file.at("recipes").items()) grid.recipes.push_back(read_recipe(item, grid.registry));
  grid.rays = {{"matched", PointSpread::kNearPlane, sources.rays}};
  if (const auto rays = file.find("rays")) {
    grid.rays.clear();
    for (const JsonReader& item : rays->items()) grid.rays.push_back(read_rays(item, sources));
  }
  grid.seeds = {sources.seed};
  if (const auto seeds = file.find("seeds")) {
    grid.seeds.clear();
    for (const JsonReader& item : seeds->items()) grid.seeds.push_back(item.whole_number(0, UINT32_MAX));
  }
  grid.repeats = static_cast<uint32_t>(file.has("repeats") ? file.at("repeats").whole_number(1, kMostRepeats) : 1);
  if (const auto global = file.find("global"))
    grid.global = global->with_place([&] { return parse_recipe(global->text(), grid.registry); });
  return grid;
}

/// Looks at the file's content: whatever is wrong with it, the file is to be mended, not the call.
template <class Read>
auto as_content(const std::string& path, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    const bool placed = error.where.starts_with(path);
    throw Error(error.code == ErrorCode::kUsage ? ErrorCode::kMalformed : error.code, placed ? error.where : path,
                placed ? error.message : error.where + ": " + error.message, error.hint);
  }
}

/// The scenes asked for. Those whose models are missing have a name, too.
void choose_scenes(StudyGrid& grid, const StudySources& sources) {
  std::vector<std::string_view> names;
  for (const StudyScene& scene : grid.scenes) names.push_back(scene.name);
  for (const std::string& line : grid.missing) names.push_back(std::string_view(line).substr(0, line.find(':')));
  study::check_wanted(sources, names);
  std::erase_if(grid.scenes, [&](const StudyScene& scene) { return !study::is_wanted(sources, scene.name); });
}

}  // namespace

StudyGrid load_study_grid(const std::string& path, const StudySources& sources) {
  StudyGrid grid = as_content(path, [&] { return read_grid(path, sources); });
  choose_scenes(grid, sources);
  as_content(path, [&] {
    study::check_study(make_study(grid));
    return true;
  });
  return grid;
}

}  // namespace raygrain

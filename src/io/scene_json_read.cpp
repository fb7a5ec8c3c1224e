#include <array>
#include <filesystem>

#include "io/scene_json.h"
#include "io/text.h"

namespace raygrain {
namespace {

constexpr std::string_view kSceneFormat = "raygrain-scene", kAreasFormat = "raygrain-areas";
constexpr uint64_t kVersion = 1;
constexpr std::array<std::string_view, 7> kSceneKeys{"format",     "version", "name", "meshes",
                                                     "procedural", "areas",   "rays"};

void check_format(const JsonReader& root, std::string_view expected) {
  const std::string hint = "Start with \"format\": \"" + std::string(expected) + "\", \"version\": 1";
  const auto format = root.find("format");
  if (!format || !root.has("version")) root.fail(ErrorCode::kMalformed, "\"format\" or \"version\" is missing", hint);
  if (format->text() != expected)
    format->fail(ErrorCode::kUnsupported, "unknown format " + in_quotes(format->text()), hint);
  const JsonReader version = root.at("version");
  if (version.whole_number(0, ~uint64_t{0}) != kVersion)
    version.fail(ErrorCode::kUnsupported, "this is another version than 1, the only one known so far",
                 "Was it written by a newer raygrain?");
}

ProceduralOptions read_procedural(const JsonReader& item) {
  return item.with_place([&] { return parse_procedural(item.text()); });
}

// The mesh of a scene, and for a procedural one its own areas and rays.
Scene read_geometry(const JsonReader& root, const LoadOptions& options) {
  constexpr std::array<std::string_view, 2> kSources{"meshes", "procedural"};
  const std::string_view source = root.one_of(kSources);
  if (source == "procedural") return generate_scene(read_procedural(root.at(source)));
  Scene scene;
  LoadReport report;
  scene.mesh = read_meshes(root.at(source), options, report);
  scene.dropped_lines = report.dropped_lines;
  scene.dropped_points = report.dropped_points;
  return scene;
}

Scene read_scene(const JsonReader& root, const LoadOptions& options) {
  root.expect_keys(kSceneKeys);
  check_format(root, kSceneFormat);
  const auto name = root.find("name");
  const std::string scene_name = name ? name->text() : file_stem(root.path());
  Scene scene = read_geometry(root, options);
  scene.name = scene_name;
  const SceneBounds bounds = [&] { return mesh_bounds(scene.mesh); };
  if (const auto areas = root.find("areas")) {
    scene.areas = read_areas(*areas, bounds);
    scene.ray_sets.clear();  // those of a procedural scene follow its own areas
  }
  if (const auto rays = root.find("rays")) scene.ray_sets = read_ray_sets(*rays, scene.areas, bounds);
  return scene;
}

bool is_whole_scene(const JsonReader& root) {
  return root.has("meshes") || root.has("procedural");
}

std::vector<InfluenceArea> not_empty(std::vector<InfluenceArea> areas, const JsonReader& place) {
  if (areas.empty()) place.fail(ErrorCode::kMalformed, "there is no area", "Add one under \"areas\"");
  return areas;
}

std::vector<InfluenceArea> areas_of_scene(const JsonReader& root) {
  return not_empty(read_scene(root, {}).areas, root);
}

// Such a file needs no format, but must not have a wrong one.
std::vector<InfluenceArea> read_areas_alone(const JsonReader& root, const SceneBounds& bounds) {
  constexpr std::array<std::string_view, 3> kKeys{"format", "version", "areas"};
  root.expect_keys(kKeys);
  const JsonReader list = root.at("areas");
  if (root.has("format") || root.has("version")) check_format(root, kAreasFormat);
  return not_empty(read_areas(list, bounds), list);
}

}  // namespace

Scene read_scene(const std::string& path, const LoadOptions& options) {
  const JsonValue document = parse_json(path, read_whole_file(path));
  return read_scene(JsonReader(document, path), options);
}

std::vector<InfluenceArea> load_areas(const std::string& path) {
  const JsonValue document = parse_json(path, read_whole_file(path));
  const JsonReader root(document, path);
  if (is_whole_scene(root)) return areas_of_scene(root);
  return read_areas_alone(root, []() -> Bounds {
    throw Error(ErrorCode::kUsage, "", "this needs a scene to fit", "Describe a \"plane\" or \"point\" in full");
  });
}

std::vector<InfluenceArea> load_areas(const std::string& path, const Bounds& scene) {
  const JsonValue document = parse_json(path, read_whole_file(path));
  const JsonReader root(document, path);
  if (is_whole_scene(root)) {
    root.expect_keys(kSceneKeys);
    check_format(root, kSceneFormat);
    const auto areas = root.find("areas");
    return areas ? not_empty(read_areas(*areas, [&] { return scene; }), *areas) : areas_of_scene(root);
  }
  return read_areas_alone(root, [&] { return scene; });
}

std::string file_stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

}  // namespace raygrain

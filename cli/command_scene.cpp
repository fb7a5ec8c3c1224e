// raygrain scene: make, convert and describe scenes.
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raygrain/io.h"

#include "cli/commands.h"
#include "cli/open_scene.h"
#include "cli/output.h"
#include "cli/values.h"

namespace raygrain::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  CommonOptions common;
  std::string scene, output;
  std::optional<uint64_t> size, seed;
};

Json numbers(Vec3 v) {
  return {v.x, v.y, v.z};
}

Json area_json(const InfluenceArea& area) {
  const bool plane = std::holds_alternative<PlaneArea>(area.shape);
  return {{"name", area.name}, {"kind", plane ? "plane" : "point"}};
}

std::string info_json(const Scene& scene) {
  const Bounds box = mesh_bounds(scene.mesh);
  Json info{{"scene", scene.name},
            {"triangles", scene.mesh.triangle_count()},
            {"vertices", scene.mesh.vertices.size()},
            {"bounds", {{"lo", numbers(box.lo)}, {"hi", numbers(box.hi)}}},
            {"dropped_lines", scene.dropped_lines},
            {"dropped_points", scene.dropped_points},
            {"areas", Json::array()},
            {"ray_sets", Json::array()}};
  for (const InfluenceArea& area : scene.areas) info["areas"].push_back(area_json(area));
  for (const RaySet& set : scene.ray_sets) info["ray_sets"].push_back({{"name", set.name}, {"count", ray_count(set)}});
  return info.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string area_text(const InfluenceArea& area) {
  if (const auto* plane = std::get_if<PlaneArea>(&area.shape))
    return fmt::format("{} (plane, {:g} x {:g} x {:g}, along {:g},{:g},{:g})", area.name, 2 * plane->half_width,
                       2 * plane->half_height, plane->depth, plane->direction.x, plane->direction.y,
                       plane->direction.z);
  const auto& point = std::get<PointArea>(area.shape);
  return fmt::format("{} (point at {:g},{:g},{:g}, {:g} x {:g} degrees)", area.name, point.eye.x, point.eye.y,
                     point.eye.z, point.fov_x, point.fov_y);
}

std::string counted(size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string info_text(const Scene& scene) {
  const Bounds box = mesh_bounds(scene.mesh);
  std::string text = fmt::format("{}: {} triangles, {} vertices\n", scene.name, scene.mesh.triangle_count(),
                                 scene.mesh.vertices.size());
  text += fmt::format("  from {:g},{:g},{:g} to {:g},{:g},{:g}\n", box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y,
                      box.hi.z);
  if (scene.dropped_lines + scene.dropped_points > 0)
    text += fmt::format("  left out, as they have no surface: {} and {}\n", counted(scene.dropped_lines, "line"),
                        counted(scene.dropped_points, "point"));
  for (const InfluenceArea& area : scene.areas) text += "  area " + area_text(area) + "\n";
  for (const RaySet& set : scene.ray_sets) text += fmt::format("  rays {} ({})\n", set.name, ray_count(set));
  return text;
}

/// Refuses endings that cannot be written, before the work.
void check_target(const std::string& path) {
  require_writable(path);
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".obj" || ending == ".ply" || ending == ".json") return;
  fail_usage(path, "'" + ending + "' is no format that can be written", "End the name with .ply, .obj or .json");
}

int save(const Options& options, const Scene& scene, const Output& output, Progress& progress) {
  progress.show("write " + options.output, 0.5);
  if (std::filesystem::path(options.output).extension() == ".json")
    save_scene(scene, options.output);
  else
    save_mesh(scene.mesh, options.output);
  progress.erase();
  output.save_json(info_json(scene));
  output.print(info_text(scene));
  output.note("Written:\n  " + options.output + "\n");
  return kSuccess;
}

ProceduralOptions procedural_options(const Options& options) {
  if (!options.scene.starts_with("procedural:"))
    return {options.scene, static_cast<uint32_t>(options.size.value_or(0)), options.seed.value_or(1)};
  ProceduralOptions result = parse_procedural(options.scene);
  const auto refuse_twice = [&](bool given, const std::string& key) {
    if (given && options.scene.find(key + "=") != std::string::npos)
      fail_usage("--" + key, "is there twice: also in " + options.scene, "Leave one of them out");
  };
  refuse_twice(options.size.has_value(), "size");
  refuse_twice(options.seed.has_value(), "seed");
  if (options.size) result.size = static_cast<uint32_t>(*options.size);
  if (options.seed) result.seed = *options.seed;
  return result;
}

int generate(const Options& options) {
  const Output output(options.common);
  check_target(options.output);
  Progress progress(!options.common.quiet);
  progress.show("make " + options.scene, 0);
  return save(options, generate_scene(procedural_options(options)), output, progress);
}

int convert(const Options& options) {
  const Output output(options.common);
  check_target(options.output);
  Progress progress(!options.common.quiet);
  return save(options, open_scene(options.scene, progress), output, progress);
}

int describe(const Options& options) {
  const Output output(options.common);
  Progress progress(!options.common.quiet);
  const Scene scene = open_scene(options.scene, progress);
  output.save_json(info_json(scene));
  output.print(info_text(scene));
  return kSuccess;
}

void add_target(Arguments& arguments, Options& options) {
  arguments.output("-o,--output", "FILE", options.output,
                   "Where to write it: .ply, .obj, or .json for a scene.json with a .ply beside it");
  arguments.require("--output");
  arguments.writes("--output", [&options] {
    const std::filesystem::path path(options.output);
    return path.extension() == ".json" ? std::filesystem::path(path).replace_extension(".ply").string() : "";
  });
}

}  // namespace

Action declare_generate(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.operand("KIND", options->scene,
                    "city, forest, terrain, random100 or random1000; or procedural:KIND?size=N&seed=S");
  arguments.optional_whole("--size", options->size, {1, UINT32_MAX, 8}, "Buildings, trees or cells per side [by kind]");
  arguments.optional_whole("--seed", options->seed, {}, "Other seeds give other scenes of the kind [1]");
  add_target(arguments, *options);
  add_common(arguments, options->common);
  return [options] { return generate(*options); };
}

Action declare_convert(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.operand("SCENE", options->scene, kSceneHelp);
  add_target(arguments, *options);
  add_common(arguments, options->common);
  return [options] { return convert(*options); };
}

Action declare_info(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.operand("SCENE", options->scene, kSceneHelp);
  add_common(arguments, options->common);
  return [options] { return describe(*options); };
}

}  // namespace raygrain::cli

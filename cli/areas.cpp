#include "cli/areas.h"

#include <fmt/format.h>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"
#include "raygrain/io.h"

#include "cli/values.h"

namespace raygrain::cli {

namespace {

constexpr float kDefaultFieldOfView = 60, kDefaultAspect = 1.5f;
constexpr float kWidestAspect = 100;

void check_sun(Vec3 direction) {
  if (direction == Vec3{})
    fail_usage("--sun", "0,0,0 is no direction",
               "Give the direction in which the light travels, e.g. --sun 0.3,-0.8,0.5");
}

void check_camera(const std::pair<Vec3, Vec3>& camera) {
  if (camera.first == camera.second)
    fail_usage("--camera", "the eye and the target are the same point", "Move one of them");
}

std::vector<InfluenceArea> given_areas(const AreaOptions& options, const Scene& scene) {
  constexpr ErrorCode kBad = ErrorCode::kBadArea;
  const Bounds box = mesh_bounds(scene.mesh);
  if (!options.file.empty()) return load_areas(options.file, box);
  if (options.sun)
    return from_option("--sun", kBad, [&] { return std::vector{directional_light_area("sun", *options.sun, box)}; });
  if (options.light)
    return from_option("--light", kBad, [&] { return point_light_areas("light", *options.light, box); });
  if (!options.camera) return scene.areas;
  return from_option("--camera", kBad, [&] {
    const auto& [eye, target] = *options.camera;
    return std::vector{camera_area("camera", eye, target, options.field_of_view.value_or(kDefaultFieldOfView),
                                   options.aspect.value_or(kDefaultAspect), box)};
  });
}

}  // namespace

void add_area_options(Arguments& arguments, AreaOptions& options) {
  arguments.group("Influence areas (without any: the scene's own)");
  arguments.file("--areas", "FILE.json", options.file,
                 "Areas of a JSON file (format raygrain-areas), or of a scene.json");
  arguments.vector("--sun", options.sun, "0.3,-0.8,0.5",
                   "Parallel light over the whole scene; X,Y,Z is the direction in which it travels");
  arguments.vector("--light", options.light, "0,30,0", "A light at this point: six frusta of 90 degrees around it");
  arguments.two_vectors("--camera", "EYE TARGET", options.camera, "9,5,9 0,0,0", "A camera: two points X,Y,Z");
  arguments.real("--fov", "DEGREES", options.field_of_view, {0.0f, 180.0f}, "Vertical field of view of --camera [60]");
  arguments.real("--aspect", "RATIO", options.aspect, {1 / kWidestAspect, kWidestAspect},
                 "Width by height of --camera [1.5]");
}

void check_area_options(const AreaOptions& options) {
  const std::pair<bool, const char*> kinds[] = {{!options.file.empty(), "--areas"},
                                                {options.sun.has_value(), "--sun"},
                                                {options.light.has_value(), "--light"},
                                                {options.camera.has_value(), "--camera"}};
  const char* first = nullptr;
  for (const auto& [given, option] : kinds) {
    if (!given) continue;
    if (first) fail_usage(option, fmt::format("cannot be combined with {}", first), "Leave one of them out");
    first = option;
  }
  if (!options.camera && (options.field_of_view || options.aspect))
    fail_usage(options.field_of_view ? "--fov" : "--aspect", "is only for --camera", "Add --camera EYE TARGET");
  if (options.sun) check_sun(*options.sun);
  if (options.camera) check_camera(*options.camera);
}

std::vector<InfluenceArea> choose_areas(const AreaOptions& options, const Scene& scene, const Output& output) {
  std::vector<InfluenceArea> areas = given_areas(options, scene);
  std::string dropped;
  std::erase_if(areas, [&](const InfluenceArea& area) {
    if (!area_members(scene.mesh, AreaGeometry(area)).empty()) return false;
    dropped += (dropped.empty() ? "" : ", ") + area.name;
    return true;
  });
  if (!dropped.empty()) output.note(fmt::format("Left out, as no triangle lies there: {}\n", dropped));
  return areas;
}

void refuse_empty_areas(const AreaOptions& options, const Scene& scene, const std::string& name) {
  const bool given = !options.file.empty() || options.sun || options.light || options.camera;
  if (given || !scene.areas.empty())
    throw Error(ErrorCode::kBadArea, options.file.empty() ? name : options.file,
                "no triangle lies in the influence areas", "Move or enlarge the areas: see raygrain scene info");
}

void fail_without_areas(const AreaOptions& options, const Scene& scene, const std::string& name) {
  refuse_empty_areas(options, scene, name);
  fail_usage(name, "has no influence areas of its own", kAreasHint);
}

}  // namespace raygrain::cli

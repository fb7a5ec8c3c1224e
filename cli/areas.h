// Which influence areas a command works with: the scene's own, a file's, or those of a sun, a light or a camera.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "raygrain/scene.h"

#include "cli/arguments.h"
#include "cli/output.h"

namespace raygrain::cli {

struct AreaOptions {
  std::string file;  // of areas
  std::optional<Vec3> sun, light;
  std::optional<std::pair<Vec3, Vec3>> camera;  // eye and target
  std::optional<float> field_of_view, aspect;
};
void add_area_options(Arguments& arguments, AreaOptions& options);

/// Throws Error (kUsage) for options that exclude each other. Needs no scene, so it can come first.
void check_area_options(const AreaOptions& options);

/// The areas asked for, or else the scene's own (perhaps none). Those that hold no triangle are left out, with a note.
/// Throws Error.
std::vector<InfluenceArea> choose_areas(const AreaOptions& options, const Scene& scene, const Output& output);

/// Options that give areas, as a hint.
inline constexpr const char* kAreasHint =
    "Add --sun X,Y,Z (direction of the light), --light X,Y,Z, --camera EYE TARGET or --areas FILE.json";

/// For when choose_areas left none: throws Error (kBadArea) where there were some, all empty. `name` is the scene's on
/// the command line.
void refuse_empty_areas(const AreaOptions& options, const Scene& scene, const std::string& name);

/// ... or else Error (kUsage) that shows the options.
[[noreturn]] void fail_without_areas(const AreaOptions& options, const Scene& scene, const std::string& name);

}  // namespace raygrain::cli

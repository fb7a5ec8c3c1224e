// The parts of scene.json (docs/formats.md), each read in a file of its own.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/io.h"
#include "raygrain/scene.h"

#include "io/json_reader.h"

namespace raygrain {

/// The box that the shorthands "sun", "light" and "camera" are made to fit; asked only when one is there.
using SceneBounds = std::function<Bounds()>;

/// The areas of an array, shorthands expanded; names are unique. Checked.
std::vector<InfluenceArea> read_areas(const JsonReader& areas, const SceneBounds& bounds);

/// An area that an item describes: one, or six for a light.
std::vector<InfluenceArea> read_area(const JsonReader& item, const SceneBounds& bounds);

/// The ray sets of an array; `areas` are those that sets may name.
std::vector<RaySet> read_ray_sets(const JsonReader& sets, std::span<const InfluenceArea> areas,
                                  const SceneBounds& bounds);

/// The meshes of an array as one, in order, each moved to its place.
TriangleMesh read_meshes(const JsonReader& meshes, const LoadOptions& options, LoadReport& report);

/// A whole scene.json.
Scene read_scene(const std::string& path, const LoadOptions& options);

/// The text of a scene.json for a mesh in a file beside it. `ray_files` names a file beside it for each ray set whose
/// rays are there; it is empty for the others.
std::string scene_json(const Scene& scene, const std::string& mesh_file, const std::vector<std::string>& ray_files);

/// The file name without folder and ending: a scene's name where it has none.
std::string file_stem(const std::string& path);

}  // namespace raygrain

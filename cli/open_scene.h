// Scenes as the program loads them.
#pragma once

#include <string>

#include "raygrain/scene.h"

#include "cli/progress.h"

namespace raygrain::cli {

inline constexpr char kSceneHelp[] =
    "A mesh file (OBJ, PLY, STL, glTF ...), a scene.json, or procedural:city?size=40&seed=1";

/// Loads a scene with its meshes imported in a child process: a crash of an importer is an Error here. Call before any
/// thread starts.
Scene open_scene(const std::string& scene, Progress& progress);

}  // namespace raygrain::cli

// Built trees as files that commands write, read and refit.
#pragma once

#include <span>
#include <string>

#include "raygrain/bvh.h"
#include "raygrain/mesh.h"

namespace raygrain::cli {

/// By its ending, .rgt: the binary format; anything else is JSON.
bool is_tree_file(const std::string& path);

/// Reads a tree and checks it against the mesh: each of `triangles` (empty: every one of the mesh) in its leaves, and
/// inside its boxes. Throws Error, which names the file.
Bvh load_tree_for(const TriangleMesh& mesh, const std::string& path, std::span<const uint32_t> triangles = {});

}  // namespace raygrain::cli

#include "cli/tree_file.h"

#include "raygrain/error.h"
#include "raygrain/io.h"

namespace raygrain::cli {

bool is_tree_file(const std::string& path) {
  return path.ends_with(".rgt");
}

Bvh load_tree_for(const TriangleMesh& mesh, const std::string& path, std::span<const uint32_t> triangles) {
  Bvh tree = load_tree(path);
  if (const auto defect = find_defect(tree, triangle_bounds(mesh), triangles))
    throw Error(ErrorCode::kMalformed, path, "this tree is not one of this scene: " + *defect,
                "Build it again, or fit it with raygrain refit where only vertices moved");
  return tree;
}

}  // namespace raygrain::cli

// Tree files, as they are and with a right checksum. A tree that fits a mesh must answer exactly.
#include <vector>

#include "raygrain/bvh.h"
#include "raygrain/io.h"
#include "raygrain/refine.h"
#include "raygrain/trace.h"
#include "raygrain/wide.h"

#include "cube.h"
#include "files.h"
#include "io/crc32.h"

namespace raygrain::fuzz {

namespace {

void search(const Bvh& tree, const TriangleMesh& mesh) {
  const WideBvh wide(tree, mesh);
  for (const Ray& ray : rays_around(mesh)) {
    const Hit binary = intersect(tree, mesh, ray), found = wide.intersect(ray);
    occluded(tree, mesh, ray);
    wide.occluded(ray);
    // Which part of a primitive a leaf answers for is nothing that a check can see.
    if (tree.split_references) continue;
    const Hit expected = intersect_reference(mesh, ray);
    require(binary == expected, "a sound tree gave another hit");
    require(found == expected, "the wide form of a sound tree gave another hit");
  }
}

void check_tree(const std::string& path) {
  static const TriangleMesh mesh = cube();
  static const std::vector<Bounds> boxes = triangle_bounds(mesh);
  Bvh tree;
  if (!accepts([&] { tree = load_tree(path); })) return;
  static const MemoryFile written;
  written.set({});
  save_tree(tree, written.path());
  if (find_defect(tree, boxes)) return;
  search(tree, mesh);
  accepts([&] { refit(tree, boxes); });
  accepts([&] { reinsert(tree); });
  require(!find_defect(tree, boxes), "a sound tree became unsound");
  search(tree, mesh);
}

}  // namespace

void tree(Bytes bytes) {
  static const MemoryFile file;
  file.set(bytes);
  check_tree(file.path());
  if (bytes.size() < 4) return;
  // With the checksum that belongs to it: else no changed file comes further.
  std::vector<uint8_t> signed_bytes(bytes.begin(), bytes.end());
  const size_t end = bytes.size() - 4;
  const uint32_t checksum = crc32({reinterpret_cast<const char*>(bytes.data()), end});
  for (size_t i = 0; i < 4; ++i) signed_bytes[end + i] = static_cast<uint8_t>(checksum >> (8 * i));
  file.set(signed_bytes);
  check_tree(file.path());
}

}  // namespace raygrain::fuzz

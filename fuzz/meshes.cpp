// Mesh files: our own readers in this process, where sanitizers see everything; any format through the child.
#include <cstring>

#include "raygrain/io.h"

#include "files.h"
#include "io/mesh_polygons.h"

namespace raygrain::fuzz {

namespace {

/// What load_mesh does with what a reader found.
void check_polygons(PolygonMesh polygons) {
  size_t corners = 0, triangles = 0;
  for (const uint32_t size : polygons.sizes) {
    require(size >= 3, "a polygon of fewer than three corners");
    corners += size;
    triangles += size - 2;
  }
  require(corners == polygons.corners.size(), "sizes of polygons and their corners differ");
  for (const uint32_t corner : polygons.corners) require(corner < polygons.vertices.size(), "a corner out of range");
  const TriangleMesh mesh = triangulated(std::move(polygons), "fuzzed");
  require(mesh.triangle_count() == triangles, "n corners did not become n - 2 triangles");
  validate(mesh, "fuzzed");
  welded(mesh);
}

bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.vertices.size() == b.vertices.size() &&
         (a.vertices.empty() ||
          std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(Vec3)) == 0);
}

std::string ending_for(const std::string& text) {
  if (text.starts_with("glTF")) return ".glb";
  if (text.starts_with("ply")) return ".ply";
  if (text.starts_with("solid")) return ".stl";
  if (text.starts_with("OFF")) return ".off";
  if (text.starts_with("v ") || text.starts_with("#")) return ".obj";
  return ".gltf";
}

}  // namespace

void obj(Bytes bytes) {
  accepts([&] { check_polygons(parse_obj(text_of(bytes), "fuzzed.obj")); });
}

void ply(Bytes bytes) {
  accepts([&] { check_polygons(parse_ply(text_of(bytes), "fuzzed.ply")); });
}

void stl(Bytes bytes) {
  accepts([&] { check_polygons(parse_stl(text_of(bytes), "fuzzed.stl")); });
}

void import(Bytes bytes) {
  static const PrivateFolder folder;
  const std::string ending = ending_for(text_of(bytes)), path = folder.put("fuzzed" + ending, bytes);
  LoadOptions limits{Isolation::kChildProcess, uint64_t{1} << 30, 10};
  TriangleMesh mesh;
  const bool accepted = accepts([&] { mesh = load_mesh(path, limits); });
  if (accepted) {
    require(!mesh.triangles.empty(), "a mesh without triangles");
    validate(mesh, "fuzzed");
  }
  if (ending == ".gltf" || ending == ".glb") {
    announced_gltf_faces(path);
  } else if (ending != ".off") {  // read by us: the same here as in the child
    TriangleMesh here;
    require(accepts([&] { here = load_mesh(path); }) == accepted, "accepted in one process only");
    require(same_mesh(mesh, here), "another mesh in a child process");
  }
}

}  // namespace raygrain::fuzz

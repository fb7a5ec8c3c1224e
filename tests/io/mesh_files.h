// Mesh files of every format as bytes, written here and not by the code under test.
#pragma once

#include <string>
#include <vector>

#include "raygrain/error.h"
#include "raygrain/mesh.h"

#include "support/error_of.h"

namespace raygrain::test {

struct MeshFile {
  std::string name;    // e.g. "ply_text"
  std::string ending;  // e.g. ".ply"
  std::string bytes;
  bool is_read_here;  // safe to try in this process, whatever the bytes
};

/// The same mesh in OBJ, PLY (text, both byte orders), STL (text, binary), glTF and GLB.
std::vector<MeshFile> mesh_files(const TriangleMesh& mesh);

/// A glTF file with the mesh's data embedded; `nodes` is the JSON of its nodes and scenes, which use mesh 0.
std::string gltf_bytes(const TriangleMesh& mesh, const std::string& nodes);
inline const std::string kPlainNode = R"("nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}])";

/// A few triangles with coordinates of many sizes.
TriangleMesh small_mesh();
/// `triangles` random triangles over shared vertices of any finite bits.
TriangleMesh random_mesh(size_t triangles, uint64_t seed);

/// The coordinates of all corners, triangle by triangle: what must not change, however vertices are numbered.
std::vector<Vec3> corner_positions(const TriangleMesh& mesh);
/// Compares bit by bit (0 and -0 differ).
bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b);

void put_file(const std::string& path, const std::string& bytes);
std::string get_file(const std::string& path);
std::vector<std::string> file_names(const std::string& folder);

}  // namespace raygrain::test

// The formats that are not read here go through Assimp. This is the only file that knows it.
#include <cctype>
#include <new>
#include <utility>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include "raygrain/error.h"

#include "io/mesh_polygons.h"

namespace raygrain {

namespace {

/// Node transforms in double precision; Assimp's own are float.
struct Transform {
  double rows[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

  friend bool operator==(const Transform&, const Transform&) = default;
};

Transform from_assimp(const aiMatrix4x4& matrix) {
  Transform result;
  for (unsigned row = 0; row < 4; ++row)
    for (unsigned column = 0; column < 4; ++column) result.rows[row][column] = static_cast<double>(matrix[row][column]);
  return result;
}

Transform product(const Transform& a, const Transform& b) {
  Transform result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += a.rows[row][k] * b.rows[k][column];
      result.rows[row][column] = sum;
    }
  return result;
}

Vec3 transformed(const Transform& transform, const aiVector3D& point) {
  Vec3d result;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& row = transform.rows[axis];
    result[axis] = row[0] * static_cast<double>(point.x) + row[1] * static_cast<double>(point.y) +
                   row[2] * static_cast<double>(point.z) + row[3];
  }
  return to_float(result);
}

class Collector {
 public:
  Collector(const aiScene& scene, const std::string& path) : scene_(scene), path_(path) {}

  /// Depth first, parents before children, in the file's order; without recursion, since the depth is the file's.
  PolygonMesh collect() {
    std::vector<std::pair<const aiNode*, Transform>> waiting{{scene_.mRootNode, {}}};
    while (!waiting.empty()) {
      const auto [node, parent] = waiting.back();
      waiting.pop_back();
      if (!node) continue;
      const Transform transform = product(parent, from_assimp(node->mTransformation));
      for (unsigned i = 0; i < node->mNumMeshes; ++i) add_mesh(node->mMeshes[i], transform);
      for (unsigned i = node->mNumChildren; i > 0; --i) waiting.emplace_back(node->mChildren[i - 1], transform);
    }
    return std::move(mesh_);
  }

 private:
  void add_mesh(unsigned number, const Transform& transform) {
    if (number >= scene_.mNumMeshes || !scene_.mMeshes[number])
      throw Error(ErrorCode::kMalformed, path_, "a node uses mesh " + std::to_string(number) + ", which is not there");
    const aiMesh& mesh = *scene_.mMeshes[number];
    if (!mesh.mVertices || (mesh.mNumFaces > 0 && !mesh.mFaces)) return;
    const size_t base = mesh_.vertices.size();
    if (base + mesh.mNumVertices >= kNoTriangle)
      throw Error(ErrorCode::kLimit, path_, "has more vertices than 32-bit indices can name", "split the mesh");
    const bool moves = transform != Transform{};
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& point = mesh.mVertices[i];
      mesh_.vertices.push_back(moves ? transformed(transform, point) : Vec3{point.x, point.y, point.z});
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) add_face(mesh.mFaces[i], mesh.mNumVertices, base);
  }

  void add_face(const aiFace& face, unsigned vertices, size_t base) {
    if (face.mNumIndices < 3) {
      ++(face.mNumIndices == 2 ? mesh_.dropped.dropped_lines : mesh_.dropped.dropped_points);
      return;
    }
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      if (face.mIndices[i] >= vertices)
        throw Error(ErrorCode::kBadMesh, path_,
                    "a face uses vertex " + std::to_string(face.mIndices[i]) + " of " + std::to_string(vertices));
      mesh_.corners.push_back(static_cast<uint32_t>(base + face.mIndices[i]));
    }
    mesh_.sizes.push_back(face.mNumIndices);
  }

  const aiScene& scene_;
  const std::string& path_;
  PolygonMesh mesh_;
};

void check_gltf(const aiScene& scene, const std::string& path) {
  const std::string ending = path.substr(path.find_last_of('.') + 1);
  if (ending.size() < 3 || std::tolower(static_cast<unsigned char>(ending[0])) != 'g') return;
  const std::optional<uint64_t> announced = announced_gltf_faces(path);
  uint64_t imported = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) imported += scene.mMeshes[i]->mNumFaces;
  if (announced && imported < *announced)
    throw Error(ErrorCode::kBadMesh, path,
                std::to_string(*announced - imported) + " faces use vertices that are out of range",
                "indices count from 0");
}

}  // namespace

PolygonMesh import_with_assimp(const std::string& path) {
  Assimp::Importer importer;
  // No post-processing: it trusts indices, and triangulation shall not depend on Assimp's version.
  const aiScene* scene = importer.ReadFile(path, 0);
  if (!scene) {
    std::string reason = importer.GetErrorString();
    if (reason == "std::bad_alloc") throw std::bad_alloc();
    while (!reason.empty() && (reason.back() == '.' || reason.back() == '\n')) reason.pop_back();
    throw Error(ErrorCode::kMalformed, path, reason.empty() ? "cannot be imported" : reason);
  }
  check_gltf(*scene, path);
  return Collector(*scene, path).collect();
}

std::string assimp_endings() {
  aiString list;
  Assimp::Importer().GetExtensionList(list);  // "*.3ds;*.blend;..."
  std::string result;
  for (const char* next = list.C_Str(); *next; ++next) {
    if (*next == ';') result += ", ";
    if (*next != ';' && *next != '*' && *next != '.') result += *next;
  }
  return result;
}

bool assimp_knows(const std::string& ending) {
  return Assimp::Importer().IsExtensionSupported("." + ending);
}

}  // namespace raygrain

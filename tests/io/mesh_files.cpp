#include "mesh_files.h"

#include <algorithm>
#include <cinttypes>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "base/random.h"

namespace raygrain::test {
namespace {

// Nine digits name every float.
std::string text(float value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.9g", static_cast<double>(value));
  return buffer;
}
std::string text(Vec3 v) {
  return text(v.x) + " " + text(v.y) + " " + text(v.z);
}

template <class Number>
std::string raw(Number number, bool swap = false) {
  char bytes[sizeof number];
  std::memcpy(bytes, &number, sizeof number);
  if (swap) std::reverse(bytes, bytes + sizeof number);
  return {bytes, sizeof number};
}
std::string raw(Vec3 v, bool swap = false) {
  return raw(v.x, swap) + raw(v.y, swap) + raw(v.z, swap);
}

std::string obj_bytes(const TriangleMesh& mesh) {
  std::string bytes = "# a mesh\n";
  for (const Vec3& v : mesh.vertices) bytes += "v " + text(v) + "\n";
  for (const auto& t : mesh.triangles)
    bytes += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
  return bytes;
}

std::string ply_header(const TriangleMesh& mesh, const std::string& format) {
  return "ply\nformat " + format + " 1.0\ncomment a mesh\nelement vertex " + std::to_string(mesh.vertices.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string ply_text_bytes(const TriangleMesh& mesh) {
  std::string bytes = ply_header(mesh, "ascii");
  for (const Vec3& v : mesh.vertices) bytes += text(v) + "\n";
  for (const auto& t : mesh.triangles)
    bytes += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  return bytes;
}

std::string ply_binary_bytes(const TriangleMesh& mesh, bool swap) {
  std::string bytes = ply_header(mesh, swap ? "binary_big_endian" : "binary_little_endian");
  for (const Vec3& v : mesh.vertices) bytes += raw(v, swap);
  for (const auto& t : mesh.triangles) {
    bytes += '\3';
    for (const uint32_t index : t) bytes += raw(index, swap);
  }
  return bytes;
}

std::string stl_text_bytes(const TriangleMesh& mesh) {
  std::string bytes = "solid\n";
  for (size_t i = 0; i < mesh.triangle_count(); ++i) {
    bytes += " facet normal 0 0 1\n  outer loop\n";
    for (int corner = 0; corner < 3; ++corner) bytes += "   vertex " + text(mesh.vertex(i, corner)) + "\n";
    bytes += "  endloop\n endfacet\n";
  }
  return bytes + "endsolid\n";
}

std::string stl_binary_bytes(const TriangleMesh& mesh) {
  std::string bytes = "solid, though binary";
  bytes.resize(80);
  bytes += raw(static_cast<uint32_t>(mesh.triangle_count()));
  for (size_t i = 0; i < mesh.triangle_count(); ++i) {
    bytes += raw(Vec3{0, 0, 1});
    for (int corner = 0; corner < 3; ++corner) bytes += raw(mesh.vertex(i, corner));
    bytes += raw(uint16_t{0});
  }
  return bytes;
}

std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) result += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return result;
}

std::string gltf_data(const TriangleMesh& mesh) {
  std::string data;
  for (const auto& t : mesh.triangles)
    for (const uint32_t index : t) data += raw(index);
  for (const Vec3& v : mesh.vertices) data += raw(v);
  return data;
}

std::string gltf_json(const TriangleMesh& mesh, const std::string& nodes, const std::string& uri) {
  const std::string index_bytes = std::to_string(mesh.triangle_count() * 12);
  const std::string vertex_bytes = std::to_string(mesh.vertices.size() * 12);
  const std::string all_bytes = std::to_string(mesh.triangle_count() * 12 + mesh.vertices.size() * 12);
  return R"({"asset":{"version":"2.0"},"scene":0,)" + nodes +
         R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],"buffers":[{)" + uri +
         R"("byteLength":)" + all_bytes + R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" +
         index_bytes + R"(},{"buffer":0,"byteOffset":)" + index_bytes + R"(,"byteLength":)" + vertex_bytes +
         R"(}],"accessors":[{"bufferView":0,"componentType":5125,"type":"SCALAR","count":)" +
         std::to_string(mesh.triangle_count() * 3) +
         R"(},{"bufferView":1,"componentType":5126,"type":"VEC3","count":)" + std::to_string(mesh.vertices.size()) +
         "}]}";
}

std::string glb_bytes(const TriangleMesh& mesh) {
  std::string json = gltf_json(mesh, kPlainNode, "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string data = gltf_data(mesh);
  return "glTF" + raw(uint32_t{2}) + raw(static_cast<uint32_t>(28 + json.size() + data.size())) +
         raw(static_cast<uint32_t>(json.size())) + "JSON" + json + raw(static_cast<uint32_t>(data.size())) +
         std::string("BIN\0", 4) + data;
}

}  // namespace

std::string gltf_bytes(const TriangleMesh& mesh, const std::string& nodes) {
  return gltf_json(mesh, nodes, R"("uri":"data:application/octet-stream;base64,)" + base64(gltf_data(mesh)) + R"(",)");
}

std::vector<MeshFile> mesh_files(const TriangleMesh& mesh) {
  return {{"obj", ".obj", obj_bytes(mesh), true},
          {"ply_text", ".ply", ply_text_bytes(mesh), true},
          {"ply_little", ".ply", ply_binary_bytes(mesh, false), true},
          {"ply_big", ".ply", ply_binary_bytes(mesh, true), true},
          {"stl_text", ".stl", stl_text_bytes(mesh), true},
          {"stl_binary", ".stl", stl_binary_bytes(mesh), true},
          {"gltf", ".gltf", gltf_bytes(mesh, kPlainNode), false},
          {"glb", ".glb", glb_bytes(mesh), false}};
}

TriangleMesh small_mesh() {
  return {{{0, 0, 0}, {1.1f, 0, 0}, {0, -5.413955f, 0}, {1e-30f, 3.1e10f, 1}}, {{0, 1, 2}, {2, 1, 3}, {3, 0, 2}}};
}

TriangleMesh random_mesh(size_t triangles, uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  const auto any_finite = [&] {
    for (;;) {
      const auto bits = static_cast<uint32_t>(random.next());
      float value = 0;
      std::memcpy(&value, &bits, sizeof value);
      if (std::isfinite(value)) return value;
    }
  };
  for (size_t i = 0; i < triangles / 2 + 3; ++i) mesh.vertices.push_back({any_finite(), any_finite(), any_finite()});
  for (size_t i = 0; i < triangles; ++i) {
    const auto index = [&] { return static_cast<uint32_t>(random.below(mesh.vertices.size())); };
    const uint32_t a = index(), b = index();
    mesh.triangles.push_back({a, b, index()});
  }
  return mesh;
}

std::vector<Vec3> corner_positions(const TriangleMesh& mesh) {
  std::vector<Vec3> positions;
  for (size_t i = 0; i < mesh.triangle_count(); ++i)
    for (int corner = 0; corner < 3; ++corner) positions.push_back(mesh.vertex(i, corner));
  return positions;
}

bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0);
}

void put_file(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string get_file(const std::string& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

std::vector<std::string> file_names(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace raygrain::test

#include <bit>
#include <filesystem>
#include <ostream>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "io/text.h"

namespace raygrain {

namespace {

constexpr size_t kBlock = size_t{1} << 16;

void flush(std::ostream& stream, std::string& text, size_t limit) {
  if (text.size() < limit) return;
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  text.clear();
}

void write_obj(const TriangleMesh& mesh, std::ostream& stream) {
  std::string text;
  for (const Vec3& vertex : mesh.vertices) {
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) {
      text += ' ';
      append_float(text, vertex[axis]);
    }
    text += '\n';
    flush(stream, text, kBlock);
  }
  for (const auto& triangle : mesh.triangles) {
    text += 'f';
    for (const uint32_t index : triangle) text += ' ' + std::to_string(uint64_t{index} + 1);
    text += '\n';
    flush(stream, text, kBlock);
  }
  flush(stream, text, 0);
}

void append_word(std::string& bytes, uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xff);
}

void write_ply(const TriangleMesh& mesh, std::ostream& stream) {
  stream << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertices.size()
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
         << "\nproperty list uchar uint vertex_indices\nend_header\n";
  std::string bytes;
  for (const Vec3& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) append_word(bytes, std::bit_cast<uint32_t>(vertex[axis]));
    flush(stream, bytes, kBlock);
  }
  for (const auto& triangle : mesh.triangles) {
    bytes += '\3';
    for (const uint32_t index : triangle) append_word(bytes, index);
    flush(stream, bytes, kBlock);
  }
  flush(stream, bytes, 0);
}

}  // namespace

void save_mesh(const TriangleMesh& mesh, const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending != ".obj" && ending != ".ply")
    throw Error(ErrorCode::kUnsupported, path, "meshes are written as .obj or .ply", "choose one of these endings");
  validate(mesh, path);
  write_file_atomically(path, [&](std::ostream& stream) {
    if (ending == ".obj")
      write_obj(mesh, stream);
    else
      write_ply(mesh, stream);
  });
}

}  // namespace raygrain

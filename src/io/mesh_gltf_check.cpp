// Assimp leaves out faces of glTF files whose indices are out of range, and says so only in its log. The file's own
// counts tell.
#include <nlohmann/json.hpp>

#include "raygrain/error.h"

#include "io/mesh_polygons.h"
#include "io/text.h"

namespace raygrain {

namespace {

using nlohmann::json;

/// The JSON of a .gltf file or of a .glb file's first chunk; nothing that is not for us to refuse throws.
json parse_document(const std::string& bytes) {
  constexpr size_t kChunk = 20;  // magic, version, length; length and type of the chunk
  const bool is_binary = bytes.starts_with("glTF") && bytes.size() > kChunk;
  size_t size = bytes.size();
  if (is_binary) {
    size = 0;
    for (size_t i = 16; i-- > 12;) size = size << 8 | static_cast<uint8_t>(bytes[i]);
    size = std::min(size, bytes.size() - kChunk);
  }
  const char* begin = bytes.data() + (is_binary ? kChunk : 0);
  return json::parse(begin, begin + size, nullptr, false);
}

/// Faces, lines and points of a primitive with `count` corners.
uint64_t face_count(uint64_t mode, uint64_t count) {
  switch (mode) {
    case 1:  // lines
      return count / 2;
    case 3:  // line strip
      return count - std::min<uint64_t>(count, 1);
    case 4:  // triangles
      return count / 3;
    case 5:  // triangle strip
    case 6:  // triangle fan
      return count - std::min<uint64_t>(count, 2);
    default:  // points, line loop
      return count;
  }
}

uint64_t count_primitive(const json& document, const json& primitive) {
  const json& attributes = primitive.at("attributes");
  if (!primitive.contains("indices") && !attributes.contains("POSITION")) return 0;
  const json& accessor = primitive.contains("indices") ? primitive["indices"] : attributes["POSITION"];
  const uint64_t corners = document.at("accessors").at(accessor.get<size_t>()).at("count").get<uint64_t>();
  return face_count(primitive.value("mode", uint64_t{4}), corners);
}

}  // namespace

std::optional<uint64_t> announced_gltf_faces(const std::string& path) {
  try {
    const json document = parse_document(read_whole_file(path));
    if (!document.is_object() || !document.at("asset").at("version").get<std::string>().starts_with("2"))
      return std::nullopt;
    uint64_t faces = 0;
    for (const json& mesh : document.value("meshes", json::array()))
      for (const json& primitive : mesh.at("primitives")) faces += count_primitive(document, primitive);
    return faces;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

}  // namespace raygrain

// The header of a PLY file (Turk, "The PLY polygon file format", 1994).
#pragma once

#include <string>
#include <vector>

namespace raygrain {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };
enum class PlyEncoding { kText, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;  // of the value, or of a list's items
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;
};
struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
};
struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  std::vector<PlyElement> elements;
  size_t body = 0;   // offset of the first byte behind the header
  size_t lines = 0;  // of the header
};

/// Throws Error (kMalformed, kUnsupported) naming file:line.
PlyHeader parse_ply_header(const std::string& bytes, const std::string& path);

}  // namespace raygrain

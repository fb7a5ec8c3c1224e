#include "io/mesh_ply.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <string_view>

#include "raygrain/error.h"

#include "io/mesh_polygons.h"
#include "io/text.h"

namespace raygrain {

namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& message) {
  throw Error(ErrorCode::kMalformed, where, message);
}

/// The values of a text body, one word each.
class TextValues {
 public:
  TextValues(std::string_view body, size_t line, const std::string& path) : rest_(body), path_(path), line_(line) {}

  std::string where() const { return place(path_, line_); }
  size_t bytes_left() const { return rest_.size(); }
  std::string_view rest() const { return rest_; }

  float real(PlyType) {
    const std::string_view word = take_word();
    const std::optional<float> value = parse_float(word);
    if (!value) refuse(where(), in_quotes(word) + " is not a number that a float can hold");
    return *value;
  }
  int64_t integer(PlyType) {
    const std::string_view word = take_word();
    int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size())
      refuse(where(), in_quotes(word) + " is not an integer");
    return value;
  }
  void skip(PlyType, uint64_t count) {
    for (uint64_t i = 0; i < count; ++i) take_word();
  }

 private:
  std::string_view take_word() {
    while (!rest_.empty() && (is_blank(rest_.front()) || rest_.front() == '\n')) {
      line_ += rest_.front() == '\n';
      rest_.remove_prefix(1);
    }
    size_t end = 0;
    while (end < rest_.size() && !is_blank(rest_[end]) && rest_[end] != '\n') ++end;
    if (end == 0) refuse(where(), "the file ends before its last element");
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }

  std::string_view rest_;
  const std::string& path_;
  size_t line_;
};

constexpr size_t byte_size(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 8;
}

/// The values of a binary body.
class BinaryValues {
 public:
  BinaryValues(std::string_view body, bool little_endian, const std::string& path)
      : rest_(body), path_(path), little_endian_(little_endian) {}

  const std::string& where() const { return path_; }
  size_t bytes_left() const { return rest_.size(); }
  std::string_view rest() const { return rest_; }

  float real(PlyType type) {
    if (type == PlyType::kFloat32) return std::bit_cast<float>(static_cast<uint32_t>(take(4)));
    if (type == PlyType::kFloat64) return static_cast<float>(std::bit_cast<double>(take(8)));
    return static_cast<float>(integer(type));
  }
  int64_t integer(PlyType type) {
    const uint64_t bits = take(byte_size(type));
    switch (type) {
      case PlyType::kInt8:
        return static_cast<int8_t>(bits);
      case PlyType::kInt16:
        return static_cast<int16_t>(bits);
      case PlyType::kInt32:
        return static_cast<int32_t>(bits);
      default:
        return static_cast<int64_t>(bits);
    }
  }
  void skip(PlyType type, uint64_t count) {
    if (count > rest_.size() / byte_size(type)) refuse(path_, "the file ends before its last element");
    rest_.remove_prefix(count * byte_size(type));
  }

 private:
  uint64_t take(size_t bytes) {
    if (rest_.size() < bytes) refuse(path_, "the file ends before its last element");
    uint64_t value = 0;
    for (size_t i = 0; i < bytes; ++i)
      value = value << 8 | static_cast<uint8_t>(rest_[little_endian_ ? bytes - 1 - i : i]);
    rest_.remove_prefix(bytes);
    return value;
  }

  std::string_view rest_;
  const std::string& path_;
  bool little_endian_;
};

template <class Values>
class BodyReader {
 public:
  BodyReader(const PlyHeader& header, Values values) : header_(header), values_(values) {}

  PolygonMesh read() {
    for (const PlyElement& element : header_.elements)
      if (element.name == "vertex") vertex_count_ += element.count;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else
        skip_elements(element);
    }
    if (values_.rest().find_first_not_of(std::string_view(" \t\r\n\0", 5)) != std::string_view::npos)
      refuse(values_.where(), "more data follows than the header announces");
    return std::move(mesh_);
  }

 private:
  uint64_t length(const PlyProperty& property) {
    if (!property.is_list) return 1;
    const int64_t count = values_.integer(property.count_type);
    if (count < 0) refuse(values_.where(), "a list has a negative length");
    return static_cast<uint64_t>(count);
  }

  void skip_property(const PlyProperty& property) {
    const uint64_t count = length(property);
    values_.skip(property.type, count);
  }

  void skip_elements(const PlyElement& element) {
    if (element.name == "tristrips" && element.count > 0)
      throw Error(ErrorCode::kUnsupported, values_.where(), "triangle strips are not read", "save plain faces");
    if (element.properties.empty()) return;
    for (uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) skip_property(property);
    if (element.name == "edge") mesh_.dropped.dropped_lines += element.count;
  }

  void read_vertices(const PlyElement& element) {
    std::vector<int> axes;  // of each property, or -1
    for (const PlyProperty& property : element.properties) {
      const size_t axis =
          property.is_list || property.name.size() != 1 ? 3 : std::string_view("xyz").find(property.name);
      axes.push_back(axis < 3 ? static_cast<int>(axis) : -1);
    }
    for (const int axis : {0, 1, 2})
      if (std::count(axes.begin(), axes.end(), axis) != 1)
        refuse(values_.where(), std::string("the vertices have no single property \"") + "xyz"[axis] + "\"");
    mesh_.vertices.reserve(std::min<uint64_t>(element.count, values_.bytes_left() / 3));
    for (uint64_t i = 0; i < element.count; ++i) {
      Vec3 vertex;
      for (size_t p = 0; p < axes.size(); ++p) {
        if (axes[p] >= 0)
          vertex[axes[p]] = values_.real(element.properties[p].type);
        else
          skip_property(element.properties[p]);
      }
      mesh_.vertices.push_back(vertex);
    }
  }

  static bool holds_corners(const PlyProperty& property) {
    return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  void read_faces(const PlyElement& element) {
    if (element.count == 0) return;
    if (std::count_if(element.properties.begin(), element.properties.end(), holds_corners) != 1)
      refuse(values_.where(), "the faces have no single list \"vertex_indices\"");
    mesh_.sizes.reserve(std::min<uint64_t>(element.count, values_.bytes_left()));
    mesh_.corners.reserve(std::min<uint64_t>(element.count * 3, values_.bytes_left()));
    for (uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) {
        if (holds_corners(property))
          read_corners(property, i);
        else
          skip_property(property);
      }
  }

  void read_corners(const PlyProperty& property, uint64_t face) {
    if (property.type >= PlyType::kFloat32) refuse(values_.where(), "vertex indices are not integers");
    const uint64_t size = length(property);
    if (size < 3) {
      values_.skip(property.type, size);
      ++(size == 2 ? mesh_.dropped.dropped_lines : mesh_.dropped.dropped_points);
      return;
    }
    if (size > values_.bytes_left()) refuse(values_.where(), "the file ends before its last element");
    for (uint64_t corner = 0; corner < size; ++corner) {
      const int64_t index = values_.integer(property.type);
      if (index < 0 || static_cast<uint64_t>(index) >= vertex_count_)
        throw Error(ErrorCode::kBadMesh, values_.where(),
                    "face " + std::to_string(face) + " uses vertex " + std::to_string(index) + " of " +
                        std::to_string(vertex_count_),
                    "indices count from 0");
      mesh_.corners.push_back(static_cast<uint32_t>(index));
    }
    mesh_.sizes.push_back(static_cast<uint32_t>(size));
  }

  const PlyHeader& header_;
  Values values_;
  uint64_t vertex_count_ = 0;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh parse_ply(const std::string& bytes, const std::string& path) {
  const PlyHeader header = parse_ply_header(bytes, path);
  const std::string_view body = std::string_view(bytes).substr(header.body);
  if (header.encoding == PlyEncoding::kText) return BodyReader(header, TextValues(body, header.lines + 1, path)).read();
  const bool little_endian = header.encoding == PlyEncoding::kLittleEndian;
  return BodyReader(header, BinaryValues(body, little_endian, path)).read();
}

}  // namespace raygrain

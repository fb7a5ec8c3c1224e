// Stereolithography files, text or binary; several solids in one text file follow each other.
#include <algorithm>
#include <bit>
#include <cctype>
#include <string_view>

#include "raygrain/error.h"

#include "io/mesh_polygons.h"
#include "io/text.h"

namespace raygrain {

namespace {

constexpr size_t kHeaderBytes = 84, kFacetBytes = 50, kNormalBytes = 12;

uint32_t read_word(const char* bytes) {
  uint32_t word = 0;
  for (int i = 3; i >= 0; --i) word = word << 8 | static_cast<uint8_t>(bytes[i]);
  return word;
}

PolygonMesh parse_binary(const std::string& bytes, size_t count) {
  PolygonMesh mesh;
  mesh.vertices.reserve(count * 3);
  mesh.sizes.assign(count, 3);
  for (size_t facet = 0; facet < count; ++facet) {
    const char* next = bytes.data() + kHeaderBytes + facet * kFacetBytes + kNormalBytes;
    for (int corner = 0; corner < 3; ++corner) {
      Vec3 vertex;
      for (int axis = 0; axis < 3; ++axis, next += 4) vertex[axis] = std::bit_cast<float>(read_word(next));
      mesh.corners.push_back(static_cast<uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(vertex);
    }
  }
  return mesh;
}

class TextReader {
 public:
  TextReader(const std::string& bytes, const std::string& path) : rest_(bytes), path_(path) {}

  PolygonMesh read() {
    for (std::string_view token = take_token(); !token.empty(); token = take_token()) {
      if (!is(token, "solid")) refuse("solid", token);
      skip_line();
      read_solid();
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(const char* expected, std::string_view found) const {
    throw Error(ErrorCode::kMalformed, place(path_, line_),
                found.empty() ? std::string("the file ends where \"") + expected + "\" is expected"
                              : "expected \"" + std::string(expected) + "\", found " + in_quotes(found));
  }

  static bool is(std::string_view token, std::string_view keyword) {
    return token.size() == keyword.size() &&
           std::equal(token.begin(), token.end(), keyword.begin(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
  }

  std::string_view take_token() {
    while (!rest_.empty() && (is_blank(rest_.front()) || rest_.front() == '\n')) {
      line_ += rest_.front() == '\n';
      rest_.remove_prefix(1);
    }
    size_t end = 0;
    while (end < rest_.size() && !is_blank(rest_[end]) && rest_[end] != '\n') ++end;
    const std::string_view token = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return token;
  }
  void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }
  void expect(const char* keyword) {
    const std::string_view token = take_token();
    if (!is(token, keyword)) refuse(keyword, token);
  }

  void read_solid() {
    for (;;) {
      const std::string_view token = take_token();
      if (is(token, "endsolid")) return skip_line();
      if (!is(token, "facet")) refuse("facet", token);
      expect("normal");
      for (int axis = 0; axis < 3; ++axis)
        if (take_token().empty()) refuse("normal", {});
      read_loop();
      expect("endfacet");
    }
  }

  void read_loop() {
    expect("outer");
    expect("loop");
    uint32_t size = 0;
    for (std::string_view token = take_token(); !is(token, "endloop"); token = take_token(), ++size) {
      if (!is(token, "vertex")) refuse("vertex", token);
      read_vertex();
    }
    if (size < 3) throw Error(ErrorCode::kMalformed, place(path_, line_), "a facet has fewer than three vertices");
    mesh_.sizes.push_back(size);
  }

  void read_vertex() {
    Vec3 vertex;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view token = take_token();
      const std::optional<float> value = parse_float(token);
      if (!value) refuse("number", token);
      vertex[axis] = *value;
    }
    if (!is_finite(vertex))
      throw Error(ErrorCode::kBadMesh, place(path_, line_),
                  "vertex " + std::to_string(mesh_.vertices.size()) + " is not finite",
                  "remove NaN and infinite coordinates");
    mesh_.corners.push_back(static_cast<uint32_t>(mesh_.vertices.size()));
    mesh_.vertices.push_back(vertex);
  }

  std::string_view rest_;
  const std::string& path_;
  size_t line_ = 1;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh parse_stl(const std::string& bytes, const std::string& path) {
  // Binary files may begin with "solid", too: only their length tells.
  const bool has_header = bytes.size() >= kHeaderBytes;
  const uint64_t count = has_header ? read_word(bytes.data() + 80) : 0;
  if (has_header && bytes.size() == kHeaderBytes + count * kFacetBytes) return parse_binary(bytes, count);
  const size_t start = bytes.find_first_not_of(" \t\r\n");
  if (start != std::string::npos && (bytes.compare(start, 5, "solid") == 0 || bytes.compare(start, 5, "SOLID") == 0))
    return TextReader(bytes, path).read();
  if (!has_header) throw Error(ErrorCode::kMalformed, path, "is neither a text nor a binary STL file");
  throw Error(ErrorCode::kMalformed, path,
              "has " + std::to_string(bytes.size()) + " bytes where its " + std::to_string(count) + " triangles need " +
                  std::to_string(kHeaderBytes + count * kFacetBytes),
              "the file may be cut off");
}

}  // namespace raygrain

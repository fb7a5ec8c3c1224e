// Wavefront OBJ: v, f, l and p; groups, objects and materials do not change the order of faces.
#include <algorithm>
#include <charconv>
#include <string_view>

#include "raygrain/error.h"

#include "io/mesh_polygons.h"
#include "io/text.h"

namespace raygrain {

namespace {

class ObjReader {
 public:
  ObjReader(const std::string& bytes, const std::string& path) : rest_(bytes), path_(path) {}

  PolygonMesh read() {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    while (next_line()) read_statement();
    if (mesh_.sizes.empty() && unknown_line_ > 0)
      throw Error(ErrorCode::kBadMesh, place(path_, unknown_line_),
                  in_quotes(unknown_) + " was not understood, and the file has no triangles",
                  "faces look like: f 1 2 3");
    if (highest_ > mesh_.vertices.size()) refuse_index(std::to_string(highest_), highest_line_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(const std::string& message, const char* hint = "") const {
    throw Error(ErrorCode::kMalformed, place(path_, line_number_), message, hint);
  }
  [[noreturn]] void refuse_index(const std::string& index, size_t line) const {
    throw Error(ErrorCode::kBadMesh, place(path_, line),
                "a face uses vertex " + index + " of " + std::to_string(mesh_.vertices.size()),
                "indices count from 1, or back from -1");
  }

  std::string_view take_physical_line() {
    const size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++lines_read_;
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  /// A line with those that a backslash at its end joins to it, without comment.
  bool next_line() {
    if (rest_.empty()) return false;
    line_number_ = lines_read_ + 1;
    line_ = take_physical_line();
    if (line_.ends_with('\\')) {
      joined_.clear();
      while (line_.ends_with('\\')) {
        joined_ += line_.substr(0, line_.size() - 1);
        joined_ += ' ';
        line_ = take_physical_line();
      }
      joined_ += line_;
      line_ = joined_;
    }
    if (line_.find('\0') != std::string_view::npos) refuse("is not a text file");
    line_ = line_.substr(0, line_.find('#'));
    return true;
  }

  std::string_view take_token() {
    while (!line_.empty() && is_blank(line_.front())) line_.remove_prefix(1);
    size_t end = 0;
    while (end < line_.size() && !is_blank(line_[end])) ++end;
    const std::string_view token = line_.substr(0, end);
    line_.remove_prefix(end);
    return token;
  }

  void read_statement() {
    const std::string_view keyword = take_token();
    if (keyword == "v")
      read_vertex();
    else if (keyword == "f" || keyword == "fo")
      read_face();
    else if (keyword == "l")
      mesh_.dropped.dropped_lines += std::max<size_t>(count_tokens(), 2) - 1;
    else if (keyword == "p")
      mesh_.dropped.dropped_points += count_tokens();
    else if (unknown_line_ == 0 && !is_known(keyword))
      note_unknown(keyword);
  }

  /// What a file of words is no mesh for.
  void note_unknown(std::string_view keyword) {
    unknown_line_ = line_number_;
    unknown_ = std::string(keyword) + std::string(line_.substr(0, 40));
  }

  static bool is_known(std::string_view keyword) {
    constexpr std::string_view kIgnored[] = {"",       "vt",     "vn",     "vp",     "g",   "o",    "s",    "mg",
                                             "mtllib", "usemtl", "usemap", "maplib", "lod", "curv", "surf", "end"};
    return std::find(std::begin(kIgnored), std::end(kIgnored), keyword) != std::end(kIgnored);
  }

  size_t count_tokens() {
    size_t count = 0;
    while (!take_token().empty()) ++count;
    return count;
  }

  float take_coordinate() {
    const std::string_view token = take_token();
    if (token.empty()) refuse("a vertex has fewer than three coordinates");
    const std::optional<float> value = parse_float(token);
    if (!value) refuse(in_quotes(token) + " is not a coordinate that a float can hold");
    return *value;
  }

  void read_vertex() {
    Vec3 vertex;
    for (int axis = 0; axis < 3; ++axis) vertex[axis] = take_coordinate();
    if (!is_finite(vertex))
      throw Error(ErrorCode::kBadMesh, place(path_, line_number_),
                  "vertex " + std::to_string(mesh_.vertices.size()) + " is not finite",
                  "remove NaN and infinite coordinates");
    mesh_.vertices.push_back(vertex);
  }

  /// "7", "7/1", "7//3", "7/1/3" or with negative numbers: the vertex, counted from 0.
  uint32_t parse_corner(std::string_view token) {
    int64_t index = 0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), index);
    const std::string_view tail = token.substr(static_cast<size_t>(end - token.data()));
    if (error == std::errc::invalid_argument || (!tail.empty() && tail.front() != '/') ||
        tail.find_first_not_of("/-0123456789") != std::string_view::npos)
      refuse(in_quotes(token) + " is not a corner of a face", "corners look like 7, 7/1, 7//3 or 7/1/3");
    const auto count = static_cast<int64_t>(mesh_.vertices.size());
    if (error != std::errc{} || index == 0 || index < -count || index >= int64_t{kNoTriangle})
      refuse_index(std::string(token.substr(0, 24)), line_number_);
    if (index < 0) return static_cast<uint32_t>(count + index);
    // A vertex may stand further down in the file.
    if (index > static_cast<int64_t>(highest_)) {
      highest_ = static_cast<size_t>(index);
      highest_line_ = line_number_;
    }
    return static_cast<uint32_t>(index - 1);
  }

  void read_face() {
    const size_t begin = mesh_.corners.size();
    for (std::string_view token = take_token(); !token.empty(); token = take_token())
      mesh_.corners.push_back(parse_corner(token));
    const size_t size = mesh_.corners.size() - begin;
    if (size >= 3) return mesh_.sizes.push_back(static_cast<uint32_t>(size));
    if (size == 0) refuse("a face has no corners");
    ++(size == 2 ? mesh_.dropped.dropped_lines : mesh_.dropped.dropped_points);
    mesh_.corners.resize(begin);
  }

  std::string_view rest_, line_;
  std::string joined_;
  const std::string& path_;
  size_t line_number_ = 0, lines_read_ = 0;
  size_t highest_ = 0, highest_line_ = 0;  // of all indices counted from 1
  size_t unknown_line_ = 0;                // the first that says nothing known; 0: none
  std::string unknown_;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh parse_obj(const std::string& bytes, const std::string& path) {
  return ObjReader(bytes, path).read();
}

}  // namespace raygrain

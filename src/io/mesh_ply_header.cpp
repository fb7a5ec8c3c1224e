#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "raygrain/error.h"

#include "io/mesh_ply.h"
#include "io/text.h"

namespace raygrain {

namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{{"char", PlyType::kInt8},
                                                                       {"int8", PlyType::kInt8},
                                                                       {"uchar", PlyType::kUint8},
                                                                       {"uint8", PlyType::kUint8},
                                                                       {"short", PlyType::kInt16},
                                                                       {"int16", PlyType::kInt16},
                                                                       {"ushort", PlyType::kUint16},
                                                                       {"uint16", PlyType::kUint16},
                                                                       {"int", PlyType::kInt32},
                                                                       {"int32", PlyType::kInt32},
                                                                       {"uint", PlyType::kUint32},
                                                                       {"uint32", PlyType::kUint32},
                                                                       {"float", PlyType::kFloat32},
                                                                       {"float32", PlyType::kFloat32},
                                                                       {"double", PlyType::kFloat64},
                                                                       {"float64", PlyType::kFloat64}}};

using Words = std::vector<std::string_view>;

Words split(std::string_view line) {
  Words words;
  while (!(line = trimmed(line)).empty()) {
    size_t end = 0;
    while (end < line.size() && !is_blank(line[end])) ++end;
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

class HeaderReader {
 public:
  HeaderReader(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  PlyHeader read() {
    if (take_line() != "ply") refuse("does not begin with \"ply\"");
    for (;;) {
      const std::string_view line = take_line();
      const Words words = split(line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      read_statement(words, line);
    }
    if (!has_format_) refuse("the header has no format");
    return std::move(header_);
  }

 private:
  [[noreturn]] void refuse(const std::string& message, ErrorCode code = ErrorCode::kMalformed) const {
    throw Error(code, place(path_, header_.lines), message);
  }

  std::string_view take_line() {
    const size_t end = bytes_.find('\n', header_.body);
    if (end == std::string::npos) {
      ++header_.lines;
      refuse("the header has no end");
    }
    std::string_view line(bytes_.data() + header_.body, end - header_.body);
    header_.body = end + 1;
    ++header_.lines;
    return trimmed(line);
  }

  void read_statement(const Words& words, std::string_view line) {
    if (words[0] == "format" && words.size() == 3)
      read_format(words[1], words[2]);
    else if (words[0] == "element" && words.size() == 3)
      read_element(words[1], words[2]);
    else if (words[0] == "property" && words.size() == 3)
      add_property({std::string(words[2]), type(words[1])});
    else if (words[0] == "property" && words.size() == 5 && words[1] == "list")
      add_property({std::string(words[4]), type(words[3]), true, type(words[2])});
    else
      refuse("not a line of a PLY header: " + in_quotes(line));
  }

  void read_format(std::string_view encoding, std::string_view version) {
    if (encoding == "ascii")
      header_.encoding = PlyEncoding::kText;
    else if (encoding == "binary_little_endian")
      header_.encoding = PlyEncoding::kLittleEndian;
    else if (encoding == "binary_big_endian")
      header_.encoding = PlyEncoding::kBigEndian;
    else
      refuse("unknown format " + in_quotes(encoding), ErrorCode::kUnsupported);
    if (version != "1.0") refuse("unknown version " + in_quotes(version), ErrorCode::kUnsupported);
    has_format_ = true;
  }

  void read_element(std::string_view name, std::string_view count_text) {
    PlyElement element{std::string(name), 0, {}};
    const char* last = count_text.data() + count_text.size();
    const auto [end, error] = std::from_chars(count_text.data(), last, element.count);
    if (error != std::errc{} || end != last) refuse(in_quotes(count_text) + " is not a number of elements");
    header_.elements.push_back(std::move(element));
  }

  void add_property(PlyProperty property) {
    if (header_.elements.empty()) refuse("a property stands before the first element");
    if (property.is_list && property.count_type >= PlyType::kFloat32) refuse("a list's length is not an integer");
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType type(std::string_view name) const {
    for (const auto& [known, type] : kTypes)
      if (known == name) return type;
    refuse("unknown type " + in_quotes(name), ErrorCode::kUnsupported);
  }

  const std::string& bytes_;
  const std::string& path_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

PlyHeader parse_ply_header(const std::string& bytes, const std::string& path) {
  return HeaderReader(bytes, path).read();
}

}  // namespace raygrain

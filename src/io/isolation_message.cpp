#include "io/isolation_message.h"

#include <cstring>
#include <type_traits>

namespace raygrain {

namespace {

constexpr uint64_t kMeshMagic = 0x314d48534d475201, kErrorMagic = 0x3152524553475201;
constexpr uint64_t kLastErrorCode = static_cast<uint64_t>(ErrorCode::kCancelled);

template <class Item>
void append(std::string& message, const Item* items, size_t count) {
  static_assert(std::is_trivially_copyable_v<Item>);
  message.append(reinterpret_cast<const char*>(items), count * sizeof(Item));
}
void append(std::string& message, uint64_t number) {
  append(message, &number, 1);
}
void append(std::string& message, const std::string& text) {
  append(message, uint64_t{text.size()});
  message += text;
}

class Cursor {
 public:
  Cursor(const std::string& message, const std::string& path) : message_(message), path_(path) {}

  [[noreturn]] void refuse() const {
    throw Error(ErrorCode::kMalformed, path_, "the importer ended without a whole result",
                "the file is probably damaged");
  }
  template <class Item>
  void take(Item* items, uint64_t count) {
    if (count > (message_.size() - next_) / sizeof(Item)) refuse();
    if (count > 0) std::memcpy(items, message_.data() + next_, count * sizeof(Item));
    next_ += count * sizeof(Item);
  }
  template <class Item>
  std::vector<Item> take_items(uint64_t count) {
    if (count > (message_.size() - next_) / sizeof(Item)) refuse();
    std::vector<Item> items(count);
    take(items.data(), count);
    return items;
  }
  uint64_t take_number() {
    uint64_t number = 0;
    take(&number, 1);
    return number;
  }
  std::string take_text() {
    const std::vector<char> text = take_items<char>(take_number());
    return {text.begin(), text.end()};
  }
  void expect_end() const {
    if (next_ != message_.size()) refuse();
  }

 private:
  const std::string& message_;
  const std::string& path_;
  size_t next_ = 0;
};

[[noreturn]] void throw_error(Cursor& cursor) {
  const uint64_t code = cursor.take_number();
  std::string where = cursor.take_text(), text = cursor.take_text(), hint = cursor.take_text();
  cursor.expect_end();
  if (code > kLastErrorCode) cursor.refuse();
  throw Error(static_cast<ErrorCode>(code), std::move(where), std::move(text), std::move(hint));
}

}  // namespace

std::string encode_mesh(const TriangleMesh& mesh, const LoadReport& report) {
  std::string message;
  message.reserve(48 + mesh.vertices.size() * sizeof(Vec3) + mesh.triangles.size() * sizeof(mesh.triangles[0]));
  append(message, kMeshMagic);
  append(message, uint64_t{report.dropped_lines});
  append(message, uint64_t{report.dropped_points});
  append(message, uint64_t{mesh.vertices.size()});
  append(message, uint64_t{mesh.triangles.size()});
  append(message, mesh.vertices.data(), mesh.vertices.size());
  append(message, mesh.triangles.data(), mesh.triangles.size());
  return message;
}

std::string encode_error(const Error& error) {
  std::string message;
  append(message, kErrorMagic);
  append(message, static_cast<uint64_t>(error.code));
  append(message, error.where);
  append(message, error.message);
  append(message, error.hint);
  return message;
}

TriangleMesh decode_message(const std::string& message, const std::string& path, LoadReport& report) {
  Cursor cursor(message, path);
  const uint64_t magic = cursor.take_number();
  if (magic == kErrorMagic) throw_error(cursor);
  if (magic != kMeshMagic) cursor.refuse();
  report.dropped_lines = cursor.take_number();
  report.dropped_points = cursor.take_number();
  const uint64_t vertices = cursor.take_number(), triangles = cursor.take_number();
  TriangleMesh mesh;
  mesh.vertices = cursor.take_items<Vec3>(vertices);
  mesh.triangles = cursor.take_items<std::array<uint32_t, 3>>(triangles);
  cursor.expect_end();
  return mesh;
}

}  // namespace raygrain

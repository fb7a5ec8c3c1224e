// A JSON value with its place: every demand that it does not meet becomes an Error that names file and JSON pointer.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raygrain/error.h"
#include "raygrain/vec.h"

#include "io/json_value.h"

namespace raygrain {

class JsonReader {
 public:
  /// Both must outlive the reader and those made from it.
  JsonReader(const JsonValue& value, const std::string& path) : value_(&value), path_(&path) {}

  /// "FILE#/areas/0/plane", or the file alone for the whole document.
  std::string where() const { return pointer_.empty() ? *path_ : *path_ + '#' + pointer_; }
  const std::string& path() const { return *path_; }
  [[noreturn]] void fail(ErrorCode code, const std::string& message, const std::string& hint = {}) const;

  /// Is an object with no other keys than these.
  void expect_keys(std::span<const std::string_view> known) const;
  /// The one key of `choices` that the object has; fails for none or several.
  std::string_view one_of(std::span<const std::string_view> choices) const;

  bool has(std::string_view key) const { return find(key).has_value(); }
  std::optional<JsonReader> find(std::string_view key) const;
  JsonReader at(std::string_view key) const;
  std::vector<JsonReader> items() const;

  bool is_text() const { return value_->kind == JsonValue::Kind::kText; }
  bool is_number() const { return value_->kind == JsonValue::Kind::kNumber; }
  bool is_null() const { return value_->kind == JsonValue::Kind::kNull; }

  /// A text that is not empty.
  const std::string& text() const;
  float number() const;
  uint64_t whole_number(uint64_t least, uint64_t most) const;
  /// An array of three numbers.
  Vec3 vector() const;
  /// The position of the text among `names`.
  size_t choice(std::span<const std::string_view> names) const;

  float number_or(std::string_view key, float otherwise) const;
  Vec3 vector_or(std::string_view key, Vec3 otherwise) const;

  /// Calls make() and gives the errors it throws this place.
  template <class Make>
  auto with_place(const Make& make) const {
    try {
      return make();
    } catch (const Error& error) {
      throw Error(error.code, where(), error.message, error.hint);
    }
  }

 private:
  JsonReader(const JsonValue& value, const std::string& path, std::string pointer)
      : value_(&value), path_(&path), pointer_(std::move(pointer)) {}
  void expect(JsonValue::Kind kind) const;

  const JsonValue* value_;
  const std::string* path_;
  std::string pointer_;
};

}  // namespace raygrain

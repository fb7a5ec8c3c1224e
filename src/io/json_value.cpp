#include "io/json_value.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "raygrain/error.h"

#include "io/text.h"

namespace raygrain {
namespace {

constexpr size_t kMostLevels = 32;
constexpr size_t kMostKeys = 64;  // no object of a known format has as many; keeps the search for repeated keys short

// Builds the tree from the parser's events; the signatures are nlohmann::json_sax's.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) {}

  JsonValue take() { return std::move(root_); }

  bool null() override { return add({}); }
  bool boolean(bool value) override {
    JsonValue node = make(JsonValue::Kind::kBoolean);
    node.boolean = value;
    return add(std::move(node));
  }
  bool number_integer(number_integer_t value) override {
    return add_text(JsonValue::Kind::kNumber, std::to_string(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return add_text(JsonValue::Kind::kNumber, std::to_string(value));
  }
  bool number_float(number_float_t, const string_t& digits) override {
    return add_text(JsonValue::Kind::kNumber, digits);
  }
  bool string(string_t& value) override { return add_text(JsonValue::Kind::kText, value); }
  bool binary(binary_t&) override { return false; }
  bool start_object(size_t) override { return open(JsonValue::Kind::kObject); }
  bool start_array(size_t) override { return open(JsonValue::Kind::kArray); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override;
  bool parse_error(size_t position, const std::string& token, const nlohmann::json::exception& error) override;

 private:
  static JsonValue make(JsonValue::Kind kind) {
    JsonValue value;
    value.kind = kind;
    return value;
  }
  bool add(JsonValue value) {
    place(std::move(value));
    return true;
  }
  bool add_text(JsonValue::Kind kind, const std::string& text) {
    JsonValue node = make(kind);
    node.text = text;
    return add(std::move(node));
  }
  JsonValue& place(JsonValue value) {
    if (open_.empty()) return root_ = std::move(value);
    open_.back()->items.push_back(std::move(value));
    return open_.back()->items.back();
  }
  // Pointers stay good: the vector of an open value's siblings does not grow before the value is closed.
  bool open(JsonValue::Kind kind) {
    if (open_.size() == kMostLevels)
      throw Error(ErrorCode::kLimit, path_, "more than " + std::to_string(kMostLevels) + " levels of brackets");
    open_.push_back(&place(make(kind)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  const std::string& path_;
  const std::string& bytes_;
  JsonValue root_;
  std::vector<JsonValue*> open_;
};

bool TreeBuilder::key(string_t& name) {
  std::vector<std::string>& keys = open_.back()->keys;
  if (std::find(keys.begin(), keys.end(), name) != keys.end())
    throw Error(ErrorCode::kMalformed, path_, "key " + in_quotes(name) + " is there twice in one object", "Remove one");
  if (keys.size() == kMostKeys)
    throw Error(ErrorCode::kLimit, path_, "an object has more than " + std::to_string(kMostKeys) + " keys");
  keys.push_back(name);
  return true;
}

bool TreeBuilder::parse_error(size_t position, const std::string& token, const nlohmann::json::exception& error) {
  const size_t end = std::min(position > 0 ? position - 1 : 0, bytes_.size());
  const auto line =
      static_cast<size_t>(std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
  const size_t line_begin = end == 0 ? std::string::npos : bytes_.rfind('\n', end - 1);
  const size_t column = line_begin == std::string::npos ? end + 1 : end - line_begin;
  const std::string where = raygrain::place(path_, line + 1, column);
  if (dynamic_cast<const nlohmann::json::out_of_range*>(&error))
    throw Error(ErrorCode::kMalformed, where, "the number " + in_quotes(token) + " is too large");
  if (end >= bytes_.size()) throw Error(ErrorCode::kMalformed, where, "the file ends too early", "Is it complete?");
  throw Error(ErrorCode::kMalformed, where, "this is not JSON, at " + in_quotes(token),
              "Check commas, quotes and brackets; JSON knows no comments, NaN or Infinity");
}

}  // namespace

JsonValue parse_json(const std::string& path, const std::string& bytes) {
  TreeBuilder builder(path, bytes);
  nlohmann::json::sax_parse(bytes, &builder);
  return builder.take();
}

std::string json_text(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace raygrain

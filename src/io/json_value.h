// JSON as a plain tree, read strictly: no comments, no repeated keys, no deep nesting. Numbers keep their digits, so
// that each can become the nearest float without rounding twice.
#pragma once

#include <string>
#include <vector>

namespace raygrain {

struct JsonValue {
  enum class Kind { kNull, kBoolean, kNumber, kText, kArray, kObject };

  Kind kind = Kind::kNull;
  bool boolean = false;
  std::string text;               // of a text, or a number's digits
  std::vector<std::string> keys;  // of an object, beside `items`
  std::vector<JsonValue> items;   // of an array or object
};

/// Throws Error: kMalformed at file:line:column for broken syntax, or naming the JSON pointer of a repeated key; kLimit
/// for more than 32 levels or 64 keys in one object.
JsonValue parse_json(const std::string& path, const std::string& bytes);

/// A JSON text with its quotes. Bytes that are no UTF-8 are replaced.
std::string json_text(const std::string& text);

}  // namespace raygrain

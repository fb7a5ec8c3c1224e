#include "io/json_reader.h"

#include <algorithm>
#include <charconv>

#include "base/nearest_name.h"
#include "io/text.h"

namespace raygrain {
namespace {

const char* kind_name(JsonValue::Kind kind) {
  switch (kind) {
    case JsonValue::Kind::kNull:
      return "null";
    case JsonValue::Kind::kBoolean:
      return "true or false";
    case JsonValue::Kind::kNumber:
      return "a number";
    case JsonValue::Kind::kText:
      return "a text";
    case JsonValue::Kind::kArray:
      return "an array";
    case JsonValue::Kind::kObject:
      return "an object";
  }
  return "nothing";
}

// RFC 6901.
std::string pointer_token(std::string_view key) {
  std::string token;
  for (const char symbol : key) {
    if (symbol == '~')
      token += "~0";
    else if (symbol == '/')
      token += "~1";
    else
      token += symbol;
  }
  return token;
}

std::string listed(std::span<const std::string_view> names) {
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " or " : ", ";
    list.append(1, '"').append(names[i]).append(1, '"');
  }
  return list;
}

}  // namespace

void JsonReader::fail(ErrorCode code, const std::string& message, const std::string& hint) const {
  throw Error(code, where(), message, hint);
}

void JsonReader::expect(JsonValue::Kind kind) const {
  if (value_->kind == kind) return;
  fail(ErrorCode::kMalformed, std::string("this is ") + kind_name(value_->kind) + ", not " + kind_name(kind));
}

void JsonReader::expect_keys(std::span<const std::string_view> known) const {
  expect(JsonValue::Kind::kObject);
  for (const std::string& key : value_->keys)
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail(ErrorCode::kMalformed, "unknown key " + in_quotes(key), suggestion(key, known));
}

std::string_view JsonReader::one_of(std::span<const std::string_view> choices) const {
  std::string_view found;
  for (const std::string_view choice : choices) {
    if (!has(choice)) continue;
    if (!found.empty())
      fail(ErrorCode::kMalformed, "both " + in_quotes(found) + " and " + in_quotes(choice) + " are given",
           "Give one of " + listed(choices));
    found = choice;
  }
  if (found.empty()) fail(ErrorCode::kMalformed, "one of " + listed(choices) + " is missing");
  return found;
}

std::optional<JsonReader> JsonReader::find(std::string_view key) const {
  expect(JsonValue::Kind::kObject);
  const auto found = std::find(value_->keys.begin(), value_->keys.end(), key);
  if (found == value_->keys.end()) return std::nullopt;
  const auto index = static_cast<size_t>(found - value_->keys.begin());
  return JsonReader(value_->items[index], *path_, pointer_ + '/' + pointer_token(key));
}

JsonReader JsonReader::at(std::string_view key) const {
  std::optional<JsonReader> found = find(key);
  if (!found) fail(ErrorCode::kMalformed, "key " + in_quotes(key) + " is missing");
  return *found;
}

std::vector<JsonReader> JsonReader::items() const {
  expect(JsonValue::Kind::kArray);
  std::vector<JsonReader> readers;
  readers.reserve(value_->items.size());
  for (size_t i = 0; i < value_->items.size(); ++i)
    readers.push_back(JsonReader(value_->items[i], *path_, pointer_ + '/' + std::to_string(i)));
  return readers;
}

const std::string& JsonReader::text() const {
  expect(JsonValue::Kind::kText);
  if (value_->text.empty()) fail(ErrorCode::kMalformed, "the text is empty");
  return value_->text;
}

float JsonReader::number() const {
  expect(JsonValue::Kind::kNumber);
  const std::optional<float> value = parse_float(value_->text);
  if (!value) fail(ErrorCode::kMalformed, "the number " + value_->text + " is too large for a float");
  return *value;
}

uint64_t JsonReader::whole_number(uint64_t least, uint64_t most) const {
  expect(JsonValue::Kind::kNumber);
  const std::string& digits = value_->text;
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value < least || value > most)
    fail(ErrorCode::kMalformed,
         digits + " is no whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return value;
}

Vec3 JsonReader::vector() const {
  expect(JsonValue::Kind::kArray);
  if (value_->items.size() != 3)
    fail(ErrorCode::kMalformed, "this has " + std::to_string(value_->items.size()) + " items, not 3",
         "Write a point or direction as [x, y, z]");
  const std::vector<JsonReader> parts = items();
  return {parts[0].number(), parts[1].number(), parts[2].number()};
}

size_t JsonReader::choice(std::span<const std::string_view> names) const {
  const std::string& name = text();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) fail(ErrorCode::kMalformed, "unknown word " + in_quotes(name), suggestion(name, names));
  return static_cast<size_t>(found - names.begin());
}

float JsonReader::number_or(std::string_view key, float otherwise) const {
  const std::optional<JsonReader> found = find(key);
  return found ? found->number() : otherwise;
}

Vec3 JsonReader::vector_or(std::string_view key, Vec3 otherwise) const {
  const std::optional<JsonReader> found = find(key);
  return found ? found->vector() : otherwise;
}

}  // namespace raygrain

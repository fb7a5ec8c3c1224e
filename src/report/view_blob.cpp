#include "report/view_blob.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <zlib.h>

#include "raygrain/error.h"

namespace raygrain {

namespace {

constexpr int kEffort = 6;  // of zlib, 1 ... 9

std::vector<uint8_t> deflated(std::span<const uint8_t> bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::vector<uint8_t> packed(size);
  if (::compress2(packed.data(), &size, bytes.data(), bytes.size(), kEffort) != Z_OK)
    throw Error(ErrorCode::kLimit, "view", "the data cannot be packed", "Use a smaller scene or fewer recipes");
  packed.resize(size);
  return packed;
}

/// Base64 of RFC 4648, with padding.
void append_base64(std::string& text, std::span<const uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  text.reserve(text.size() + (bytes.size() + 2) / 3 * 4 + 1);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t left = std::min<size_t>(bytes.size() - i, 3);
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < left ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= left ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
}

}  // namespace

void ViewBlob::add(const char* name, const char* type, std::span<const uint32_t> values, int planes) {
  arrays_[name] = {{"type", type}, {"offset", bytes_.size()}, {"count", values.size()}};
  bytes_.reserve(bytes_.size() + values.size() * static_cast<size_t>(planes));
  for (int plane = 0; plane < planes; ++plane)
    for (const uint32_t value : values) bytes_.push_back(static_cast<uint8_t>(value >> (8 * plane)));
}

void ViewBlob::add_floats(const char* name, std::span<const float> values) {
  std::vector<uint32_t> bits(values.size());
  std::ranges::transform(values, bits.begin(), [](float value) { return std::bit_cast<uint32_t>(value); });
  add(name, "f32", bits, 4);
}

void ViewBlob::add_rounded_floats(const char* name, std::span<const float> values) {
  std::vector<uint32_t> bits(values.size());
  std::ranges::transform(values, bits.begin(), [](float value) {
    const auto whole = std::bit_cast<uint32_t>(value);
    return (whole + (whole < 0x7f7fff80u ? 0x80u : 0u)) >> 8;  // finite values stay so
  });
  add(name, "f24", bits, 3);
}

void ViewBlob::add_whole(const char* name, std::span<const uint32_t> values) {
  std::vector<uint32_t> steps(values.size());
  uint32_t before = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const uint32_t step = values[i] - before;
    steps[i] = step << 1 ^ (0u - (step >> 31));
    before = values[i];
  }
  add(name, "u32", steps, 4);
}

void ViewBlob::add_shares(const char* name, std::span<const float> values) {
  std::vector<uint32_t> steps(values.size());
  std::ranges::transform(values, steps.begin(), [](float value) {
    return static_cast<uint32_t>(std::lround(std::clamp(static_cast<double>(value), 0.0, 1.0) * 65535));
  });
  add(name, "share", steps, 2);
}

void ViewBlob::add_bytes(const char* name, std::span<const uint8_t> values) {
  const std::vector<uint32_t> whole(values.begin(), values.end());
  add(name, "u8", whole, 1);
}

nlohmann::ordered_json ViewBlob::write_to(std::string& lines) const {
  const size_t start = lines.size();
  append_base64(lines, deflated(bytes_));
  nlohmann::ordered_json place{
      {"start", start}, {"length", lines.size() - start}, {"bytes", bytes_.size()}, {"arrays", arrays_}};
  lines += '\n';
  return place;
}

}  // namespace raygrain

// Arrays packed for a web page: byte planes, deflated, as base64.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace raygrain {

/// Arrays that are unpacked together. Each is stored as planes: first the low bytes of all its numbers, then the next
/// ones. docs/formats.md, section "What a view holds", has the layout.
class ViewBlob {
 public:
  void add_floats(const char* name, std::span<const float> values);
  /// Without their lowest byte: 16 bits of precision.
  void add_rounded_floats(const char* name, std::span<const float> values);
  /// As differences to the number before, zigzag: small where neighbours are near.
  void add_whole(const char* name, std::span<const uint32_t> values);
  /// Of [0, 1], in 65535 steps.
  void add_shares(const char* name, std::span<const float> values);
  void add_bytes(const char* name, std::span<const uint8_t> values);

  /// Appends the packed bytes as a line of `lines` and returns where they are and what they hold.
  nlohmann::ordered_json write_to(std::string& lines) const;

 private:
  void add(const char* name, const char* type, std::span<const uint32_t> values, int planes);

  nlohmann::ordered_json arrays_ = nlohmann::ordered_json::object();
  std::vector<uint8_t> bytes_;
};

}  // namespace raygrain

// Built trees as files: docs/formats.md describes the bytes.
#include <algorithm>
#include <bit>
#include <ostream>
#include <string>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "io/crc32.h"
#include "io/text.h"

namespace raygrain {

namespace {

constexpr std::string_view kMagic = "raygrain tree\r\n\x1a";  // 16 bytes; text transfer and `cat` show at once
constexpr uint32_t kVersion = 1, kSplitReferences = 1;
constexpr size_t kHeader = 40, kNode = 32, kPrim = 4, kChecksum = 4;

void put(std::string& out, uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
}

uint64_t get(std::string_view bytes, size_t at, int count) {
  uint64_t value = 0;
  for (int i = 0; i < count; ++i)
    value |= uint64_t{static_cast<uint8_t>(bytes[at + static_cast<size_t>(i)])} << (8 * i);
  return value;
}

uint32_t get32(std::string_view bytes, size_t at) {
  return static_cast<uint32_t>(get(bytes, at, 4));
}

void put(std::string& out, const Bvh::Node& node) {
  for (const Vec3 corner : {node.bounds.lo, node.bounds.hi})
    for (int axis = 0; axis < 3; ++axis) put(out, std::bit_cast<uint32_t>(corner[axis]), 4);
  put(out, node.first, 4);
  put(out, node.count, 4);
}

Bvh::Node get_node(std::string_view bytes, size_t at) {
  Bvh::Node node;
  for (int axis = 0; axis < 3; ++axis) {
    const size_t offset = at + 4 * static_cast<size_t>(axis);
    node.bounds.lo[axis] = std::bit_cast<float>(get32(bytes, offset));
    node.bounds.hi[axis] = std::bit_cast<float>(get32(bytes, offset + 12));
  }
  node.first = get32(bytes, at + 24);
  node.count = get32(bytes, at + 28);
  return node;
}

[[noreturn]] void fail(const std::string& path, const std::string& message) {
  throw Error(ErrorCode::kMalformed, path, message, "save the tree again");
}

/// Everything that can be told without the primitives: each gets the box of its first leaf, or of all its leaves where
/// references are split.
std::optional<std::string> find_structural_defect(const Bvh& bvh) {
  Bvh dense = bvh;  // with ids 0, 1, 2 ...
  std::vector<uint32_t> ids = bvh.prims;
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  for (uint32_t& prim : dense.prims)
    prim = static_cast<uint32_t>(std::lower_bound(ids.begin(), ids.end(), prim) - ids.begin());
  std::vector<Bounds> boxes(ids.size());
  for (const Bvh::Node& node : bvh.nodes) {
    if (!node.is_leaf()) continue;
    if (size_t{node.first} + node.count > bvh.prims.size()) return "a leaf has primitives out of range";
    for (size_t i = node.first; i < size_t{node.first} + node.count; ++i)
      if (Bounds& box = boxes[dense.prims[i]]; is_empty(box) || bvh.split_references) box.extend(node.bounds);
  }
  return find_defect(dense, boxes);
}

void check_header(std::string_view bytes, const std::string& path) {
  if (bytes.substr(0, kMagic.size()) != kMagic) fail(path, "is no raygrain tree");
  if (bytes.size() < kHeader + kChecksum) fail(path, "ends early");
  const uint32_t version = get32(bytes, 16);
  if (version != kVersion)
    throw Error(ErrorCode::kUnsupported, path, "has version " + std::to_string(version) + " of the tree format",
                "this raygrain reads version 1");
  const uint64_t nodes = get(bytes, 24, 8), prims = get(bytes, 32, 8), room = bytes.size() - kHeader - kChecksum;
  if (nodes > room / kNode || prims > room / kPrim || nodes * kNode + prims * kPrim != room)
    fail(path, "has " + std::to_string(bytes.size()) + " bytes, which do not fit its header");
  if (crc32(bytes.substr(0, bytes.size() - kChecksum)) != get32(bytes, bytes.size() - kChecksum))
    fail(path, "is damaged: its checksum does not match");
  if (get32(bytes, 20) > kSplitReferences) fail(path, "has unknown flags");
}

}  // namespace

void save_tree(const Bvh& bvh, const std::string& path) {
  std::string bytes(kMagic);
  bytes.reserve(kHeader + kNode * bvh.nodes.size() + kPrim * bvh.prims.size() + kChecksum);
  put(bytes, kVersion, 4);
  put(bytes, bvh.split_references ? kSplitReferences : 0, 4);
  put(bytes, bvh.nodes.size(), 8);
  put(bytes, bvh.prims.size(), 8);
  for (const Bvh::Node& node : bvh.nodes) put(bytes, node);
  for (const uint32_t prim : bvh.prims) put(bytes, prim, 4);
  put(bytes, crc32(bytes), 4);
  write_file_atomically(
      path, [&](std::ostream& out) { out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); });
}

Bvh load_tree(const std::string& path) {
  const std::string bytes = read_whole_file(path);
  check_header(bytes, path);
  Bvh bvh;
  bvh.split_references = get32(bytes, 20) == kSplitReferences;
  bvh.nodes.resize(get(bytes, 24, 8));
  bvh.prims.resize(get(bytes, 32, 8));
  for (size_t i = 0; i < bvh.nodes.size(); ++i) bvh.nodes[i] = get_node(bytes, kHeader + kNode * i);
  const size_t prims = kHeader + kNode * bvh.nodes.size();
  for (size_t i = 0; i < bvh.prims.size(); ++i) bvh.prims[i] = get32(bytes, prims + kPrim * i);
  if (const auto defect = find_structural_defect(bvh)) fail(path, "is no sound tree: " + *defect);
  return bvh;
}

}  // namespace raygrain

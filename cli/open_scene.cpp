#include "cli/open_scene.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include "raygrain/io.h"

namespace raygrain::cli {

namespace {

constexpr uint64_t kSlowToRead = uint64_t{8} << 20;  // bytes; takes about a second
constexpr uint64_t kLeastMemory = uint64_t{1} << 30, kMemoryPerByte = 200;

bool names_other_files(const std::string& scene) {
  const std::string ending = std::filesystem::path(scene).extension().string();
  return ending == ".json" || ending == ".gltf";
}

/// What importers may use. A file that stands alone gets memory in proportion to its size: a few bytes that ask for
/// gigabytes are hostile.
LoadOptions import_limits(const std::string& scene, uint64_t bytes) {
  LoadOptions options;
  options.isolation = Isolation::kChildProcess;
  if (!names_other_files(scene) && bytes < options.memory_limit / kMemoryPerByte)
    options.memory_limit = std::min(options.memory_limit, kLeastMemory + bytes * kMemoryPerByte);
  return options;
}

}  // namespace

Scene open_scene(const std::string& scene, Progress& progress) {
  std::error_code none;
  const uintmax_t size = std::filesystem::file_size(scene, none);
  const uint64_t bytes = none ? 0 : size;
  if (scene.starts_with("procedural:"))
    progress.show("make " + scene, 0);
  else if (bytes > kSlowToRead || names_other_files(scene))
    progress.announce("reading " + scene);
  Scene result = load_scene(scene, import_limits(scene, bytes));
  progress.erase();
  return result;
}

}  // namespace raygrain::cli

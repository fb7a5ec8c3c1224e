#include "cli/open_scene.h"

#include <cstdint>
#include <filesystem>
#include <system_error>

#include "raygrain/io.h"

namespace raygrain::cli {

namespace {
constexpr uintmax_t kSlowToRead = uintmax_t{8} << 20;  // bytes; takes about a second
}

Scene open_scene(const std::string& scene, Progress& progress) {
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(scene, ignored);
  if (!ignored && bytes > kSlowToRead) progress.announce("reading " + scene);
  LoadOptions options;
  options.isolation = Isolation::kChildProcess;
  Scene result = load_scene(scene, options);
  progress.erase();
  return result;
}

}  // namespace raygrain::cli

#include "support/shared.h"

#include <cstdlib>

#include <unistd.h>

namespace raygrain::test {

std::optional<std::string> shared_scene(const std::string& file_name) {
  const char* folder = std::getenv("RAYGRAIN_SCENES");
  const std::filesystem::path path = std::filesystem::path(folder ? folder : RAYGRAIN_SHARED_SCENES) / file_name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path.string();
}

std::filesystem::path source_folder() {
  return RAYGRAIN_SOURCE_FOLDER;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "raygrain-test-XXXXXX").string();
  if (!mkdtemp(pattern.data()))
    throw std::filesystem::filesystem_error("mkdtemp", std::error_code(errno, std::generic_category()));
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace raygrain::test

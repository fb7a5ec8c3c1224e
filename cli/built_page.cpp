#include "cli/built_page.h"

#include <filesystem>

namespace raygrain::cli {

std::string built_page(const std::string& name) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const std::filesystem::path page = program.parent_path().parent_path() / "share/raygrain" / name;
  return std::filesystem::exists(page, error) ? page.string() : std::string{};
}

}  // namespace raygrain::cli

// Files for tests: optional models in a folder that a checkout may have beside it (tests that need it are skipped
// without it), the checkout itself, and temporary folders.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace raygrain::test {

/// The path of a file in the optional scenes folder (RAYGRAIN_SCENES, by default ../shared/scenes beside the source
/// tree), or nothing when it is not there.
std::optional<std::string> shared_scene(const std::string& file_name);

/// Of this project's checkout.
std::filesystem::path source_folder();

/// A fresh empty folder that is removed when the object goes.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace raygrain::test

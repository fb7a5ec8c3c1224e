// Optional models for tests: a folder that a checkout may have beside it. Tests that need it are skipped without it.
#pragma once

#include <optional>
#include <string>

namespace raygrain::test {

/// The path of a file in the optional scenes folder (RAYGRAIN_SCENES, by default ../shared/scenes beside the source
/// tree), or nothing when it is not there.
std::optional<std::string> shared_scene(const std::string& file_name);

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

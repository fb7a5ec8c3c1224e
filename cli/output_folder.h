// Folders that results go to.
#pragma once

#include <string>

namespace raygrain::cli {

/// Makes the folder at once, so that a place that cannot be written is refused before the work. What it made and
/// nothing was put into goes again, with the object or when a signal ends the program. Throws Error (kUnwritable). One
/// at a time.
class OutputFolder {
 public:
  explicit OutputFolder(const std::string& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
};

/// Removes the folders that the present OutputFolder made, as far as they are empty. Safe in a signal handler.
void remove_empty_new_folders() noexcept;

}  // namespace raygrain::cli

// Fuzzed bytes as files, for readers that take a path.
#pragma once

#include <string>

#include "targets.h"

namespace raygrain::fuzz {

/// A file that is nowhere but in memory.
class MemoryFile {
 public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void set(Bytes bytes) const;
  const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

/// A folder of its own for this process, removed at its end.
class PrivateFolder {
 public:
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Writes a file and returns its path.
  std::string put(const std::string& name, Bytes bytes) const;
  std::string put(const std::string& name, const std::string& text) const;
  /// Removes everything in it.
  void clear() const;

 private:
  std::string path_;
};

/// A mesh of two triangles as OBJ, a cube's, and three rays as CSV.
extern const char kQuadObj[], kCubeObj[], kThreeRays[];

/// Does a JSON file or a word name a procedural scene that takes long to make? Its size is no defect.
bool names_a_large_scene(const std::string& text);

}  // namespace raygrain::fuzz

// No command may write over what it reads, or one of its results over another.
#pragma once

#include <span>
#include <string>

namespace raygrain::cli {

/// A file of the command line.
struct NamedFile {
  std::string name;  // of the operand or option, for messages
  std::string path;  // empty: not given; "-": standard output
};

/// Throws Error (kUsage) where an output is an input, a file that an input names (the meshes of a scene.json, the
/// buffers of a glTF), or another output: by what the names stand for, symbolic links and hard links included. Folders
/// among the inputs stand for the results.csv in them. Devices are no files here. Changes nothing.
void require_separate(std::span<const NamedFile> inputs, std::span<const NamedFile> outputs);

}  // namespace raygrain::cli

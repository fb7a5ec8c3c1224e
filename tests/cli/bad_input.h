// A row of the table of bad inputs, and how it is checked.
#pragma once

#include <string>
#include <vector>

#include "cli/program.h"

namespace raygrain::test {

inline constexpr char kQuad[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

/// SCENE, AREAS, RAYS and OUT in the arguments stand for paths of this case's own folder.
struct BadInput {
  std::string name;
  std::vector<std::string> arguments;
  int exit_code;
  std::string expected;  // part of the message
  std::string scene_name = "scene.obj", scene = kQuad;
  std::string areas = {}, rays = {};
  RunOptions options = {};
};

/// Expects the exit code, one line on standard error that says where, what and how to mend it, and no file left.
void check(const BadInput& row);

}  // namespace raygrain::test

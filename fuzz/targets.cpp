#include "targets.h"

#include <array>

namespace raygrain::fuzz {

namespace {

constexpr std::array<Target, 13> kTargets{{{"obj", obj},
                                           {"ply", ply},
                                           {"stl", stl},
                                           {"import", import},
                                           {"scene", scene},
                                           {"areas", areas},
                                           {"study", study},
                                           {"tree", tree},
                                           {"rays", rays},
                                           {"results", results},
                                           {"command_line", command_line},
                                           {"traversal", traversal},
                                           {"structure", structure}}};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

void check_error(const Error& error) {
  require(!error.where.empty(), std::string("an error that does not say where: ") + error.what());
  require(!error.message.empty(), std::string("an error that does not say what: ") + error.what());
}

}  // namespace raygrain::fuzz

#include <fstream>
#include <string>

#include "raygrain/report.h"

#include "base/parallel.h"

// Written by the build where the source is a git checkout.
#if __has_include("raygrain_commit.h")
#include "raygrain_commit.h"
#endif
#ifndef RAYGRAIN_COMMIT
#define RAYGRAIN_COMMIT "unknown"
#endif

namespace raygrain {

namespace {

std::string compiler_name() {
#if defined(__clang__)
  return "Clang " + std::to_string(__clang_major__) + "." + std::to_string(__clang_minor__) + "." +
         std::to_string(__clang_patchlevel__);
#elif defined(__GNUC__)
  return "GCC " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + "." +
         std::to_string(__GNUC_PATCHLEVEL__);
#else
  return "unknown";
#endif
}

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const size_t start = line.find_first_not_of(" \t", line.find(':') + 1);
    return start == std::string::npos ? "unknown" : line.substr(start);
  }
  return "unknown";
}

}  // namespace

Environment current_environment(unsigned threads) {
  return {RAYGRAIN_COMMIT, compiler_name(), cpu_name(), threads == 0 ? default_threads() : threads};
}

}  // namespace raygrain

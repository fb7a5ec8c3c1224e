// Where and with what a measurement was made, for JSON results.
#pragma once

#include <nlohmann/json.hpp>

#include "raygrain/report.h"

namespace raygrain::cli {

inline nlohmann::ordered_json environment_json(unsigned threads) {
  const Environment environment = current_environment(threads);
  return {{"commit", environment.commit},
          {"compiler", environment.compiler},
          {"cpu", environment.cpu},
          {"threads", environment.threads}};
}

}  // namespace raygrain::cli

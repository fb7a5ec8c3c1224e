// The commands of the program, one file each. Each declares its arguments and returns what to do when it is chosen.
#pragma once

#include "cli/arguments.h"

namespace raygrain::cli {

Action declare_compare(Arguments& arguments);
Action declare_build(Arguments& arguments);
Action declare_analyze(Arguments& arguments);
Action declare_trace(Arguments& arguments);
Action declare_explain(Arguments& arguments);
Action declare_refit(Arguments& arguments);
Action declare_generate(Arguments& arguments);
Action declare_convert(Arguments& arguments);
Action declare_info(Arguments& arguments);
Action declare_recipes(Arguments& arguments);
Action declare_report(Arguments& arguments);
Action declare_study(Arguments& arguments);
Action declare_verify(Arguments& arguments);
Action declare_view(Arguments& arguments);

inline constexpr int kSuccess = 0, kBadData = 1, kBadUsage = 2;

}  // namespace raygrain::cli

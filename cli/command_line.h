// From the words of a command line to what they ask for.
#pragma once

#include <string>

#include "raygrain/error.h"

namespace raygrain::cli {

/// Reads the command line and does what it says; the exit code. Throws Error, and ReaderGone.
int run(int argument_count, char** arguments);

/// What is shown for an error: one line, "raygrain: error: WHERE: WHAT. HINT".
std::string error_line(const Error& error);

}  // namespace raygrain::cli

// raygrain: one program, a command for each job. Exit codes: 0 success, 1 bad data or a failed write, 2 bad usage.
#include <exception>
#include <new>
#include <string>

#include <unistd.h>

#include "raygrain/error.h"

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "cli/signals.h"

namespace raygrain::cli {
namespace {

constexpr int kReaderGone = 128 + 13;  // what a shell reports for a program that SIGPIPE ended

int fail(const Error& error) {
  const std::string line = error_line(error);
  const ssize_t ignored = ::write(STDERR_FILENO, line.data(), line.size());
  static_cast<void>(ignored);
  return error.code == ErrorCode::kUsage ? kBadUsage : kBadData;
}

int run_safely(int argument_count, char** arguments) {
  try {
    return run(argument_count, arguments);
  } catch (const ReaderGone&) {
    return kReaderGone;
  } catch (const Error& error) {
    return fail(error);
  } catch (const std::bad_alloc&) {
    return fail(Error(ErrorCode::kLimit, "memory", "there is not enough of it", "Use a smaller scene or fewer rays"));
  } catch (const std::exception& error) {
    return fail(Error(ErrorCode::kLimit, "internal", error.what(), "This is a defect of raygrain: please report it"));
  }
}

}  // namespace
}  // namespace raygrain::cli

int main(int argument_count, char** arguments) {
  raygrain::cli::install_signal_handlers();
  return raygrain::cli::run_safely(argument_count, arguments);
}

#include "cli/program.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/shared.h"

namespace raygrain::test {

namespace {

constexpr int kCannotStart = 126;

void redirect(const std::string& path, int target) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (descriptor < 0 || ::dup2(descriptor, target) < 0) ::_exit(kCannotStart);
  ::close(descriptor);
}

/// A pipe whose reading end is closed at once.
void redirect_to_nobody() {
  int ends[2];
  if (::pipe(ends) != 0 || ::dup2(ends[1], STDOUT_FILENO) < 0) ::_exit(kCannotStart);
  ::close(ends[0]);
  ::close(ends[1]);
}

void limit(int resource, const std::optional<rlim_t>& bytes) {
  if (!bytes) return;
  const rlimit limits{*bytes, *bytes};
  if (::setrlimit(resource, &limits) != 0) ::_exit(kCannotStart);
}

void become_nobody() {
  constexpr unsigned kNobody = 65534;
  if (::geteuid() == 0 && (::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) ::_exit(kCannotStart);
}

[[noreturn]] void become_program(std::vector<std::string> arguments, const std::string& output_path,
                                 const std::string& error_path, const RunOptions& options) {
  redirect(options.standard_output.empty() ? output_path : options.standard_output, STDOUT_FILENO);
  redirect(options.standard_error.empty() ? error_path : options.standard_error, STDERR_FILENO);
  if (options.closed_reader) redirect_to_nobody();
  if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) ::_exit(kCannotStart);
  // An instrumented program would write its counters under the limits that are meant for it, and tell of that.
  if (options.file_size || options.memory || options.unprivileged) {
    ::setenv("GCOV_PREFIX", "/dev/null", 1);
    ::setenv("GCOV_ERROR_FILE", "/dev/null", 1);
  }
  limit(RLIMIT_FSIZE, options.file_size);
  limit(RLIMIT_AS, options.memory);
  if (options.unprivileged) become_nobody();
  if (!options.memory_left.empty()) ::setenv("RAYGRAIN_MEMORY", options.memory_left.c_str(), 1);
  ::signal(SIGINT, SIG_DFL);
  arguments.insert(arguments.begin(), options.program.empty() ? RAYGRAIN_PROGRAM : options.program);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  // By a pointer: gcov replaces calls of execv by one that writes this process's counters first.
  int (*volatile start)(const char*, char* const*) = ::execv;
  start(pointers.front(), pointers.data());
  ::_exit(kCannotStart);
}

int exit_code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& arguments, const std::string& output_path,
                               const std::string& error_path, const RunOptions& options) {
  process_ = ::fork();
  if (process_ == 0) become_program(arguments, output_path, error_path, options);
}

RunningProgram::~RunningProgram() {
  if (exit_code_ || process_ <= 0) return;
  ::kill(process_, SIGKILL);
  wait();
}

void RunningProgram::send(int signal) const {
  ::kill(process_, signal);
}

bool RunningProgram::is_running() {
  if (exit_code_) return false;
  int status = 0;
  if (::waitpid(process_, &status, WNOHANG) == process_) exit_code_ = exit_code_of(status);
  return !exit_code_;
}

int RunningProgram::wait() {
  int status = 0;
  if (!exit_code_ && ::waitpid(process_, &status, 0) == process_) exit_code_ = exit_code_of(status);
  return exit_code_.value_or(-1);
}

RunResult run_program(const std::vector<std::string>& arguments, const RunOptions& options) {
  const TemporaryFolder folder;
  RunningProgram program(arguments, folder.file("out"), folder.file("err"), options);
  RunResult result;
  result.exit_code = program.wait();
  result.output = read_file(folder.file("out"));
  result.errors = read_file(folder.file("err"));
  return result;
}

std::string read_file(const std::string& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

void write_file(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace raygrain::test

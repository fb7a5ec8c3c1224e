// Runs the built program as a user would: with arguments, limits and redirections, and looks at what it leaves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <sys/types.h>

namespace raygrain::test {

struct RunOptions {
  std::optional<rlim_t> file_size;   // bytes that a file may grow to
  std::optional<rlim_t> memory;      // bytes of address space
  std::string standard_output = {};  // a path, e.g. /dev/full; empty: captured
  std::string standard_error = {};   // ...
  bool closed_reader = false;        // standard output is a pipe that nobody reads
  std::string folder = {};           // to run in; empty: that of the tests
  std::string program = {};          // empty: raygrain
  bool unprivileged = false;         // as another user where this one is root
  std::string memory_left = {};      // MiB that the program shall believe in
};

struct RunResult {
  int exit_code = -1;  // -signal where a signal ended it
  std::string output, errors;
};

/// Runs the program to its end.
RunResult run_program(const std::vector<std::string>& arguments, const RunOptions& options = {});

/// A program that runs in the background; killed with the object.
class RunningProgram {
 public:
  RunningProgram(const std::vector<std::string>& arguments, const std::string& output_path,
                 const std::string& error_path, const RunOptions& options = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void send(int signal) const;
  bool is_running();
  /// Waits for its end; the exit code, or -signal.
  int wait();

 private:
  pid_t process_ = -1;
  std::optional<int> exit_code_;
};

std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& content);
/// Names in a folder, hidden ones included, sorted; none where there is no folder.
std::vector<std::string> names_in(const std::string& folder);
/// The JSON files, tables and pictures of a little scene with one area take about a second.
inline const std::string kSmallScene = "procedural:city?size=4&seed=1";

}  // namespace raygrain::test

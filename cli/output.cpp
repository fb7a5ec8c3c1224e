#include "cli/output.h"

#include <cerrno>
#include <filesystem>
#include <ostream>
#include <system_error>

#include <unistd.h>

#include "raygrain/error.h"
#include "raygrain/io.h"

namespace raygrain::cli {

namespace {

constexpr uint64_t kMostThreads = 1024;

[[noreturn]] void fail_unwritable(const std::string& path, const std::string& why, const std::string& hint) {
  throw Error(ErrorCode::kUnwritable, path, why, hint);
}

}  // namespace

void add_common(Arguments& arguments, CommonOptions& options) {
  arguments.group("Common options");
  arguments.flag("-q,--quiet", options.quiet, "Print results only: no progress, no notes");
  arguments.whole("--threads", options.threads, {0, kMostThreads, 4}, "Threads to use; 0 = one per core");
  arguments.text("--json", "FILE|-", options.json, "Write the result as JSON to a file, or to standard output (-)");
  arguments.writes("--json", [&options] { return options.json; });
}

void write_standard_output(const std::string& text) {
  for (size_t done = 0; done < text.size();) {
    const ssize_t written = ::write(STDOUT_FILENO, text.data() + done, text.size() - done);
    if (written >= 0) {
      done += static_cast<size_t>(written);
    } else if (errno == EPIPE) {
      throw ReaderGone{};
    } else if (errno != EINTR) {
      fail_unwritable("standard output", "cannot write: " + std::generic_category().message(errno),
                      "Free some space or redirect it elsewhere");
    }
  }
}

void require_writable(const std::string& path) {
  if (path.empty() || path == "-") return;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail_unwritable(path, "is a folder", "Give the name of a file");
  const bool exists = std::filesystem::exists(path, ignored);
  if (exists && !std::filesystem::is_regular_file(path, ignored)) return;  // a device or pipe: writing will tell
  std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) folder = ".";
  if (!std::filesystem::is_directory(folder, ignored))
    fail_unwritable(path, "its folder does not exist", "Create " + folder.string() + " first");
  if (::access(folder.c_str(), W_OK) != 0 || (exists && ::access(path.c_str(), W_OK) != 0))
    fail_unwritable(path, "cannot write: " + std::generic_category().message(errno), "Choose another place");
}

Output::Output(const CommonOptions& options) : quiet_(options.quiet), json_path_(options.json) {
  require_writable(json_path_);
}

void Output::print(const std::string& text) const {
  if (json_path_ != "-") write_standard_output(text);
}

void Output::note(const std::string& text) const {
  if (!quiet_) print(text);
}

void Output::save_json(const std::string& json) const {
  if (json_path_.empty()) return;
  if (json_path_ == "-") return write_standard_output(json);
  write_file_atomically(json_path_, [&](std::ostream& out) { out << json; });
}

}  // namespace raygrain::cli

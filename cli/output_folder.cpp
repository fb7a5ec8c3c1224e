#include "cli/output_folder.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <unistd.h>

#include "raygrain/io.h"

namespace raygrain::cli {

namespace {

// A signal handler can be told things through such variables only.
char new_folder[4096];            // the deepest one
std::atomic<int> new_levels = 0;  // it and its parents, as far as they are new
static_assert(std::atomic<int>::is_always_lock_free, "else no handler may use them");

/// How many folders are missing on the way to `path`, itself included.
int missing_levels(std::filesystem::path path) {
  std::error_code ignored;
  int levels = 0;
  for (; !path.empty() && !std::filesystem::exists(path, ignored); path = path.parent_path()) ++levels;
  return levels;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path) {
  std::string plain = std::filesystem::path(path).lexically_normal().string();
  while (plain.size() > 1 && plain.ends_with('/')) plain.pop_back();
  const int levels = plain.size() < sizeof new_folder ? missing_levels(plain) : 0;
  if (levels > 0) std::memcpy(new_folder, plain.c_str(), plain.size() + 1);
  new_levels = levels;
  try {
    make_output_folder(path);
  } catch (...) {
    remove_empty_new_folders();
    new_levels = 0;
    throw;
  }
}

OutputFolder::~OutputFolder() {
  remove_empty_new_folders();
  new_levels = 0;
}

void remove_empty_new_folders() noexcept {
  const int saved = errno;
  char path[sizeof new_folder];
  std::memcpy(path, new_folder, sizeof path);
  for (int level = new_levels; level > 0; --level) {
    if (::rmdir(path) != 0) break;  // not empty: it stays, and so do its parents
    char* const slash = std::strrchr(path, '/');
    if (slash == nullptr) break;
    *slash = '\0';
  }
  errno = saved;
}

}  // namespace raygrain::cli

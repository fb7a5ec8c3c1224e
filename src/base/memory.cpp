#include "base/memory.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <sys/resource.h>
#include <unistd.h>

namespace raygrain {

namespace {

constexpr uint64_t kNoLimit = std::numeric_limits<uint64_t>::max();

/// A file that holds one number; nothing for "max".
std::optional<uint64_t> number_in(const std::string& path) {
  std::ifstream file(path);
  uint64_t value = 0;
  if (!(file >> value)) return std::nullopt;
  return value;
}

/// The number behind a key in a file of "key value" lines.
std::optional<uint64_t> number_of(const std::string& path, std::string_view key) {
  std::ifstream file(path);
  for (std::string word; file >> word;) {
    uint64_t value = 0;
    if (word == key && file >> value) return value;
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::nullopt;
}

uint64_t difference(uint64_t limit, uint64_t used) {
  return limit > used ? limit - used : 0;
}

uint64_t left_on_machine() {
  const auto available = number_of("/proc/meminfo", "MemAvailable:");
  if (!available) return kNoLimit;
  return (*available + number_of("/proc/meminfo", "SwapFree:").value_or(0)) * 1024;
}

/// Of one control group; what its files are cached in can be freed.
uint64_t left_in_group(const std::string& folder, const char* limit, const char* usage, const char* cached) {
  const auto most = number_in(folder + "/" + limit), used = number_in(folder + "/" + usage);
  if (!most || !used) return kNoLimit;
  return difference(*most, difference(*used, number_of(folder + "/memory.stat", cached).value_or(0)));
}

/// Of the process's groups and all above them; versions 1 and 2.
uint64_t left_in_groups() {
  uint64_t least = kNoLimit;
  std::ifstream file("/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const bool second = line.starts_with("0::");
    const size_t at = second ? 3 : line.find(":memory:");
    if (at == std::string::npos) continue;
    std::string path = line.substr(second ? 3 : at + 8);
    for (;;) {
      least = std::min(least,
                       second ? left_in_group("/sys/fs/cgroup" + path, "memory.max", "memory.current", "inactive_file")
                              : left_in_group("/sys/fs/cgroup/memory" + path, "memory.limit_in_bytes",
                                              "memory.usage_in_bytes", "total_inactive_file"));
      if (path.size() <= 1) break;
      path.resize(path.rfind('/') == std::string::npos ? 0 : path.rfind('/'));
    }
  }
  return least;
}

uint64_t left_of_limit(__rlimit_resource resource, uint64_t used) {
  rlimit limits{};
  if (::getrlimit(resource, &limits) != 0 || limits.rlim_cur == RLIM_INFINITY) return kNoLimit;
  return difference(limits.rlim_cur, used);
}

uint64_t left_of_limits() {
  std::ifstream file("/proc/self/statm");
  uint64_t size = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  if (!(file >> size >> resident >> shared >> text >> library >> data)) return kNoLimit;
  const auto page = static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
  return std::min(left_of_limit(RLIMIT_AS, size * page), left_of_limit(RLIMIT_DATA, data * page));
}

}  // namespace

uint64_t available_memory() {
  if (const char* wish = std::getenv("RAYGRAIN_MEMORY")) {
    const std::string_view digits(wish);
    uint64_t mebibytes = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), mebibytes);
    if (error == std::errc{} && end == digits.data() + digits.size() && mebibytes <= kNoLimit >> 20)
      return mebibytes << 20;
  }
  return std::min({left_on_machine(), left_in_groups(), left_of_limits()});
}

}  // namespace raygrain

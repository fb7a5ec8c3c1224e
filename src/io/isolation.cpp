#include "io/isolation.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "raygrain/error.h"

#include "io/isolation_message.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define RAYGRAIN_SHADOW_MEMORY
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RAYGRAIN_SHADOW_MEMORY
#endif

namespace raygrain {

namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void refuse_memory(const std::string& path, const LoadOptions& options) {
  throw Error(ErrorCode::kLimit, path,
              "importing needs more than " + std::to_string(options.memory_limit >> 20) + " MiB of memory",
              "the file may be damaged");
}
[[noreturn]] void refuse_time(const std::string& path, const LoadOptions& options) {
  throw Error(ErrorCode::kLimit, path, "importing takes more than " + std::to_string(options.time_limit) + " s",
              "the file may be damaged");
}
[[noreturn]] void refuse_system(const std::string& path, const char* what, int error) {
  throw Error(ErrorCode::kLimit, path, std::string(what) + ": " + std::generic_category().message(error));
}

// ---- in the child ----

#ifndef RAYGRAIN_SHADOW_MEMORY
/// What this process has mapped already does not count against the child's limit.
uint64_t mapped_bytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "re");
  if (!file) return 0;
  unsigned long pages = 0;
  const bool read = std::fscanf(file, "%lu", &pages) == 1;
  std::fclose(file);
  return read ? uint64_t{pages} * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE)) : 0;
}
#endif

void limit(__rlimit_resource resource, uint64_t soft, uint64_t hard) {
  rlimit limits{};
  if (::getrlimit(resource, &limits) != 0) return;
  limits.rlim_cur = std::min<rlim_t>(soft, limits.rlim_max);
  limits.rlim_max = std::min<rlim_t>(hard, limits.rlim_max);
  ::setrlimit(resource, &limits);
}

void limit_child(const LoadOptions& options) {
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, options.time_limit, uint64_t{options.time_limit} + 5);
#ifndef RAYGRAIN_SHADOW_MEMORY  // sanitizers map terabytes
  const uint64_t bytes = mapped_bytes() + options.memory_limit;
  limit(RLIMIT_AS, bytes, bytes);
#endif
}

/// The child shall die of its crashes, with its parent, in silence.
void detach_child(pid_t parent) {
  for (int number = 1; number < 32; ++number) ::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
}

/// Closes everything but the pipe, which becomes descriptor 3.
void keep_only(int pipe) {
  const int nothing = ::open("/dev/null", O_RDWR);
  if (nothing >= 0)
    for (const int standard : {0, 1, 2}) ::dup2(nothing, standard);
  if (pipe != 3) ::dup2(pipe, 3);
  ::close_range(4, ~0u, 0);
}

std::string import_message(const std::string& path, const LoadOptions& options, const MeshImporter& importer) {
  try {
    LoadReport report;
    const TriangleMesh mesh = importer(report);
    return encode_mesh(mesh, report);
  } catch (const Error& error) {
    return encode_error(error);
  } catch (const std::bad_alloc&) {
    try {
      refuse_memory(path, options);
    } catch (const Error& error) {
      return encode_error(error);
    }
  } catch (const std::exception& error) {
    return encode_error(Error(ErrorCode::kMalformed, path, std::string("the importer failed: ") + error.what()));
  } catch (...) {
    return encode_error(Error(ErrorCode::kMalformed, path, "the importer failed"));
  }
}

[[noreturn]] void run_child(int pipe, pid_t parent, const std::string& path, const LoadOptions& options,
                            const MeshImporter& importer) noexcept {
  detach_child(parent);
  const int output = pipe < 3 ? ::fcntl(pipe, F_DUPFD, 3) : pipe;  // out of the standard descriptors' way
  keep_only(output);
  limit_child(options);
  const std::string message = import_message(path, options, importer);
  size_t written = 0;
  while (written < message.size()) {
    const ssize_t count = ::write(3, message.data() + written, message.size() - written);
    if (count < 0 && errno != EINTR) break;
    if (count > 0) written += static_cast<size_t>(count);
  }
  ::_exit(0);  // not exit(): what this process registered for its end is not the child's to run
}

// ---- in the parent ----

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  void reset() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

/// A running child; killed and reaped at the latest when the object goes.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// The wait status; nothing to say (0) where the process lets the system reap its children.
  int wait() {
    int status = 0;
    pid_t result = 0;
    do result = ::waitpid(id_, &status, 0);
    while (result < 0 && errno == EINTR);
    id_ = -1;
    return result > 0 ? status : 0;
  }

 private:
  pid_t id_;
};

int milliseconds_until(Clock::time_point end) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
  return static_cast<int>(std::clamp<int64_t>(left, 0, 1'000'000));
}

/// Everything up to the end of the child's output.
std::string read_message(int pipe, const std::string& path, const LoadOptions& options) {
  const auto end = Clock::now() + std::chrono::seconds(uint64_t{options.time_limit} * 4 + 60);
  std::string message, block(1 << 20, '\0');
  for (;;) {
    pollfd waiting{pipe, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, milliseconds_until(end));
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0) refuse_system(path, "cannot wait for the importer", errno);
    if (ready == 0 && Clock::now() >= end) refuse_time(path, options);
    if (ready == 0) continue;
    const ssize_t count = ::read(pipe, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse_system(path, "cannot read from the importer", errno);
    if (count == 0) return message;
    message.append(block, 0, static_cast<size_t>(count));
    if (message.size() > options.memory_limit) refuse_memory(path, options);
  }
}

[[noreturn]] void refuse_signal(int number, const std::string& path, const LoadOptions& options) {
  if (number == SIGXCPU) refuse_time(path, options);
  if (number == SIGINT || number == SIGTERM || number == SIGHUP)
    throw Error(ErrorCode::kCancelled, path, "the importer was interrupted");
  if (number == SIGKILL)
    throw Error(ErrorCode::kLimit, path, "the importer was killed (signal 9)", "the system may have run out of memory");
  throw Error(ErrorCode::kMalformed, path, "the importer crashed (signal " + std::to_string(number) + ")",
              "the file is probably damaged");
}

}  // namespace

TriangleMesh import_in_child(const std::string& path, const LoadOptions& options, LoadReport& report,
                             const MeshImporter& importer) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) refuse_system(path, "cannot start an importer", errno);
  const Descriptor output(ends[0]);
  Descriptor input(ends[1]);
  const pid_t parent = ::getpid(), id = ::fork();
  if (id < 0) refuse_system(path, "cannot start an importer", errno);
  if (id == 0) run_child(input.get(), parent, path, options, importer);
  Child child(id);
  input.reset();
  const std::string message = read_message(output.get(), path, options);
  const int status = child.wait();
  if (WIFSIGNALED(status)) refuse_signal(WTERMSIG(status), path, options);
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0)
    throw Error(ErrorCode::kMalformed, path,
                "the importer gave up (exit status " + std::to_string(WEXITSTATUS(status)) + ")",
                "the file is probably damaged");
  return decode_message(message, path, report);
}

}  // namespace raygrain

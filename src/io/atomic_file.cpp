#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <ostream>
#include <streambuf>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "raygrain/error.h"
#include "raygrain/io.h"

namespace raygrain {

namespace {

// The one piece of process-wide state in the library: a signal handler can be handed nothing, so what it shall remove
// must lie where it can find it without a lock or an allocation.
enum class SlotState { kFree, kClaimed, kActive };
struct Slot {
  std::atomic<SlotState> state{SlotState::kFree};
  char path[4096];
};
static_assert(std::atomic<SlotState>::is_always_lock_free, "a signal handler must not meet a lock");
constexpr size_t kSlots = 64;
Slot slots[kSlots];

[[noreturn]] void fail(const std::string& path, int error, const char* hint = "") {
  const char* advice = hint;
  if (!*hint && (error == ENOSPC || error == EDQUOT || error == EFBIG)) advice = "free some space or write elsewhere";
  if (!*hint && (error == EACCES || error == EROFS || error == EPERM)) advice = "choose a folder that may be written";
  if (!*hint && error == ENOENT) advice = "create the folder first";
  throw Error(ErrorCode::kUnwritable, path, "cannot write: " + std::generic_category().message(error), advice);
}

/// A new empty file that goes when the object goes, unless it was kept.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& folder, const std::string& target) : target_(target) {
    for (slot_ = 0; slot_ < kSlots; ++slot_) {
      SlotState free = SlotState::kFree;
      if (slots[slot_].state.compare_exchange_strong(free, SlotState::kClaimed)) break;
    }
    if (slot_ == kSlots)
      throw Error(ErrorCode::kLimit, target,
                  "more than " + std::to_string(kSlots) + " files are being written at once");
    const int error = open_new(folder);
    if (error == 0) return;
    release();
    fail(target, error);
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!kept_) ::unlink(slots[slot_].path);
    release();
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  int descriptor() const { return descriptor_; }

  /// Brings everything to the disk and gives the file its name.
  void keep_as(const std::string& target) {
    while (::fsync(descriptor_) != 0 && errno != EINVAL)
      if (errno != EINTR) fail(target_, errno);
    if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(target_, errno);
    if (::rename(slots[slot_].path, target.c_str()) != 0) fail(target_, errno);
    kept_ = true;
  }

 private:
  int open_new(const std::string& folder) {
    Slot& slot = slots[slot_];
    const std::string stem = folder + "/.raygrain-" + std::to_string(::getpid()) + "-";
    for (size_t attempt = 0; attempt < 1000; ++attempt) {
      const std::string path = stem + std::to_string(slot_ + attempt * kSlots) + ".tmp";
      if (path.size() >= sizeof slot.path) return ENAMETOOLONG;
      std::memcpy(slot.path, path.c_str(), path.size() + 1);
      slot.state = SlotState::kActive;  // before the file is there: a signal in between must not leave it
      do descriptor_ = ::open(slot.path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      while (descriptor_ < 0 && errno == EINTR);
      if (descriptor_ >= 0) return 0;
      slot.state = SlotState::kClaimed;
      if (errno != EEXIST) return errno;
    }
    return EEXIST;
  }
  void release() { slots[slot_].state = SlotState::kFree; }

  std::string target_;
  size_t slot_ = 0;
  int descriptor_ = -1;
  bool kept_ = false;
};

/// Writes to a descriptor and remembers the first error.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor) { setp(buffer_, buffer_ + sizeof buffer_); }
  int error() const { return error_; }

 protected:
  int_type overflow(int_type symbol) override {
    if (sync() != 0) return traits_type::eof();
    if (traits_type::eq_int_type(symbol, traits_type::eof())) return traits_type::not_eof(symbol);
    *pptr() = traits_type::to_char_type(symbol);
    pbump(1);
    return symbol;
  }
  int sync() override {
    const char* next = pbase();
    while (error_ == 0 && next != pptr()) {
      const ssize_t written = ::write(descriptor_, next, static_cast<size_t>(pptr() - next));
      if (written >= 0)
        next += written;
      else if (errno != EINTR)
        error_ = errno;
    }
    setp(buffer_, buffer_ + sizeof buffer_);
    return error_ == 0 ? 0 : -1;
  }

 private:
  int descriptor_, error_ = 0;
  char buffer_[1 << 16];
};

void write_to(int descriptor, const std::string& path, const std::function<void(std::ostream&)>& write) {
  DescriptorBuffer buffer(descriptor);
  std::ostream stream(&buffer);
  write(stream);
  stream.flush();
  if (buffer.error() != 0) fail(path, buffer.error());
  if (!stream) fail(path, EIO);
}

/// The number of an already open descriptor that the path names, or -1. It must be shared, not opened again: a second
/// opening of a redirected standard output would start at its beginning.
int named_descriptor(const std::string& path) {
  if (path == "/dev/stdout") return 1;
  if (path == "/dev/stderr") return 2;
  for (const std::string prefix : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!path.starts_with(prefix) || path.size() == prefix.size() || path.size() > prefix.size() + 6) continue;
    if (path.find_first_not_of("0123456789", prefix.size()) == std::string::npos)
      return std::stoi(path.substr(prefix.size()));
  }
  return -1;
}

void write_to_device(const std::string& path, const std::function<void(std::ostream&)>& write) {
  const int shared = named_descriptor(path);
  const int descriptor =
      shared >= 0 ? ::fcntl(shared, F_DUPFD_CLOEXEC, 0) : ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) fail(path, errno);
  struct Closer {
    int descriptor;
    ~Closer() { ::close(descriptor); }
  } closer{descriptor};
  write_to(descriptor, path, write);
}

/// Where a chain of symbolic links ends, so that the link stays and its target is replaced.
std::string link_target(const std::string& path) {
  std::filesystem::path end = path;
  std::error_code error;
  for (int step = 0; step < 40 && std::filesystem::is_symlink(end, error); ++step)
    end = end.parent_path() / std::filesystem::read_symlink(end, error);
  return end.string();
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// The name itself must last, too. Best effort: some file systems cannot.
void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_file_atomically(const std::string& path, const std::function<void(std::ostream&)>& write) {
  if (path.empty()) fail(path, ENOENT, "give a file name");
  if (named_descriptor(path) >= 0) return write_to_device(path, write);
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(path, EISDIR, "give a file name");
  if (exists && !S_ISREG(status.st_mode)) return write_to_device(path, write);
  const std::string target = link_target(path), folder = folder_of(target);
  if (std::filesystem::path(target).filename().empty()) fail(path, EISDIR, "give a file name");
  TemporaryFile file(folder, path);
  write_to(file.descriptor(), path, write);
  if (exists && ::fchmod(file.descriptor(), status.st_mode & 07777) != 0) fail(path, errno);
  file.keep_as(target);
  sync_folder(folder);
}

void remove_unfinished_files() noexcept {
  const int saved = errno;
  for (const Slot& slot : slots)
    if (slot.state == SlotState::kActive) ::unlink(slot.path);
  errno = saved;
}

void make_output_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw Error(ErrorCode::kUnwritable, path, "cannot create the folder: " + error.message());
  if (!std::filesystem::is_directory(path, error))
    throw Error(ErrorCode::kUnwritable, path, "is not a folder", "choose another name");
  const TemporaryFile probe(path, path);
}

}  // namespace raygrain

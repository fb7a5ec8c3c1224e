#include "files.h"

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <sys/mman.h>
#include <unistd.h>

namespace raygrain::fuzz {

const char kQuadObj[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
const char kCubeObj[] =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
const char kThreeRays[] = "ox,oy,oz,dx,dy,dz\n0.5,0.5,-1,0,0,1\n0.25,0.5,-1,0,0,1\n0,0,-1,0,0,1\n";

MemoryFile::MemoryFile()
    : descriptor_(::memfd_create("fuzzed", MFD_CLOEXEC)), path_("/proc/self/fd/" + std::to_string(descriptor_)) {}

MemoryFile::~MemoryFile() {
  ::close(descriptor_);
}

void MemoryFile::set(Bytes bytes) const {
  const bool good = ::ftruncate(descriptor_, 0) == 0 && ::lseek(descriptor_, 0, SEEK_SET) == 0 &&
                    ::pwrite(descriptor_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
  if (!good) std::abort();  // no finding: the machine is out of memory
}

PrivateFolder::PrivateFolder() {
  const bool in_memory = ::access("/dev/shm", W_OK) == 0;
  path_ = std::string(in_memory ? "/dev/shm" : "/tmp") + "/raygrain-fuzz-XXXXXX";
  if (::mkdtemp(path_.data()) == nullptr) std::abort();
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string PrivateFolder::put(const std::string& name, Bytes bytes) const {
  std::string file = path_ + "/" + name;
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return file;
}

std::string PrivateFolder::put(const std::string& name, const std::string& text) const {
  return put(name, Bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

void PrivateFolder::clear() const {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(path_, ignored))
    std::filesystem::remove_all(entry.path(), ignored);
}

bool names_a_large_scene(const std::string& text) {
  constexpr unsigned kLarge = 12;
  if (text.find("\\u00") != std::string::npos) return true;  // may hide a name
  for (const std::string key : {"size=", "--size\n"})
    for (size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
      const char* digits = text.data() + at + key.size();
      unsigned size = 0;
      const auto [end, error] = std::from_chars(digits, text.data() + text.size(), size);
      if (end != digits && (error != std::errc{} || size > kLarge)) return true;
    }
  return false;
}

}  // namespace raygrain::fuzz

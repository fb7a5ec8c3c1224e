// Command lines: a word a line. Each runs in an empty folder that holds what words like "s.obj" name.
#include <algorithm>
#include <filesystem>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "cli/command_line.h"
#include "cli/output.h"
#include "files.h"

namespace raygrain::fuzz {

namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words{"raygrain"};
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

size_t most_digits_in_a_row(const std::string& text) {
  size_t digits = 0, most = 0;
  for (const char c : text) {
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    most = std::max(digits, most);
  }
  return most;
}

/// Not what would leave the folder, wait for a browser, or take long.
bool may_run(const std::vector<std::string>& words, const std::string& text) {
  if (names_a_large_scene(text)) return false;
  return std::none_of(words.begin(), words.end(), [](const std::string& word) {
    const bool made = word.find("procedural:") != std::string::npos && word.find("random1") == std::string::npos;
    return made || word.find_first_of(std::string_view("/\0", 2)) != std::string::npos ||
           word.find("..") != std::string::npos || word.find("serve") != std::string::npos ||
           word.find("study") != std::string::npos || word == "verify" || most_digits_in_a_row(word) > 3;
  });
}

void fill(const PrivateFolder& folder) {
  folder.clear();
  folder.put("s.obj", kQuadObj);
  folder.put("c.obj", kCubeObj);
  folder.put("r.csv", kThreeRays);
  folder.put("a.json", R"({"areas": [{"name": "sun", "sun": {"direction": [0, 0.1, 1]}}]})");
  folder.put("s.json", R"({"format": "raygrain-scene", "version": 1, "meshes": [{"file": "c.obj"}],
                         "areas": [{"name": "lamp", "light": {"position": [0.5, 0.5, 0.5]}}],
                         "rays": [{"name": "few", "rays": [[0.5, 0.5, -1, 0, 0, 1]]}]})");
  folder.put("compare.csv", "name,area,real_cost,pruned_cost\nSAH+ALL,sun,3,2\nPAH+ALL,sun,2,1\n");
}

/// In the folder, with standard output at /dev/null.
class Inside {
 public:
  explicit Inside(const PrivateFolder& folder)
      : folder_(std::filesystem::current_path()), output_(::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)) {
    std::filesystem::current_path(folder.path());
    const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(nothing, STDOUT_FILENO);
    ::close(nothing);
  }
  ~Inside() {
    ::dup2(output_, STDOUT_FILENO);
    ::close(output_);
    std::filesystem::current_path(folder_);
  }
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;

 private:
  std::filesystem::path folder_;
  int output_;
};

bool is_unfinished(const std::filesystem::directory_entry& entry) {
  return entry.path().filename().string().starts_with(".raygrain-");
}

}  // namespace

void command_line(Bytes bytes) {
  static const PrivateFolder folder;
  const std::string text = text_of(bytes);
  std::vector<std::string> words = words_of(text);
  if (!may_run(words, text)) return;
  fill(folder);
  const Inside inside(folder);
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  accepts([&] {
    try {
      const int code = cli::run(static_cast<int>(words.size()), pointers.data());
      require(code == 0, "exit code " + std::to_string(code) + " without an error");
    } catch (const Error& error) {
      const std::string line = cli::error_line(error);
      require(line.starts_with("raygrain: error: ") && std::count(line.begin(), line.end(), '\n') == 1,
              "an error is one line: " + line);
      throw;
    }
  });
  for (const auto& entry : std::filesystem::directory_iterator("."))
    require(!is_unfinished(entry), "a half-written file is left");
}

}  // namespace raygrain::fuzz

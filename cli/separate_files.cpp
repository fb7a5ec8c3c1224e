#include "cli/separate_files.h"

#include <filesystem>
#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/values.h"

namespace raygrain::cli {

namespace {

namespace fs = std::filesystem;

constexpr uintmax_t kLargestText = uintmax_t{256} << 20;  // bytes of a JSON file that is searched for names
constexpr size_t kLongestName = 4096;

void add_texts(const nlohmann::json& value, std::vector<std::string>& texts) {
  if (value.is_string() && value.get_ref<const std::string&>().size() < kLongestName) texts.push_back(value);
  if (value.is_structured())
    for (const auto& part : value) add_texts(part, texts);
}

/// Files that a scene.json or glTF names, relative to itself. Whether it is sound is for its reader to say.
std::vector<std::string> files_named_in(const std::string& path) {
  std::error_code none;
  const std::string ending = fs::path(path).extension().string();
  if ((ending != ".json" && ending != ".gltf") || !fs::is_regular_file(path, none)) return {};
  if (fs::file_size(path, none) > kLargestText || none) return {};
  std::ifstream file(path);
  const nlohmann::json value = nlohmann::json::parse(file, nullptr, false);
  std::vector<std::string> texts;
  if (!value.is_discarded()) add_texts(value, texts);
  std::vector<std::string> paths;
  for (const std::string& text : texts)
    if (const fs::path beside = fs::path(path).parent_path() / text; fs::is_regular_file(beside, none))
      paths.push_back(beside.string());
  return paths;
}

/// Do both names stand for one file, or would they, once it is there?
bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code none;
  if (fs::exists(a, none) && fs::exists(b, none)) return fs::is_regular_file(a, none) && fs::equivalent(a, b, none);
  const fs::path first = fs::weakly_canonical(fs::absolute(a, none), none);
  return !none && first == fs::weakly_canonical(fs::absolute(b, none), none);
}

std::vector<std::string> files_of(const std::string& input) {
  std::error_code none;
  if (fs::is_directory(input, none)) return {(fs::path(input) / "results.csv").string()};
  std::vector<std::string> files = files_named_in(input);
  files.push_back(input);
  return files;
}

bool is_file_name(const NamedFile& file) {
  return !file.path.empty() && file.path != "-";
}

}  // namespace

void require_separate(std::span<const NamedFile> inputs, std::span<const NamedFile> outputs) {
  for (const NamedFile& input : inputs) {
    if (!is_file_name(input)) continue;
    for (const std::string& file : files_of(input.path))
      for (const NamedFile& output : outputs)
        if (is_file_name(output) && is_same_file(output.path, file))
          fail_usage(output.name, "'" + output.path + "' would overwrite what " + input.name + " is read from",
                     "Give another name");
  }
  for (size_t i = 0; i < outputs.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (is_file_name(outputs[i]) && is_file_name(outputs[j]) && is_same_file(outputs[i].path, outputs[j].path))
        fail_usage(outputs[i].name, "'" + outputs[i].path + "' is written by " + outputs[j].name + ", too",
                   "Give each a name of its own");
}

}  // namespace raygrain::cli

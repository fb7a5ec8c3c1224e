#include "study/sources.h"

#include <algorithm>
#include <filesystem>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "base/nearest_name.h"
#include "io/crc32.h"
#include "io/text.h"
#include "study/paper_experiments.h"

namespace raygrain::study {
namespace {

constexpr double kLargeWeight = 10;

/// About a thousand triangles weigh one.
double weight_of(std::string_view scene) {
  if (scene == "Sponza" || scene == "Crowd") return 300;
  if (scene == "Random100") return 0.1;
  return scene == "Random1000" || scene == "Suzanne" ? 1 : 6;
}

}  // namespace

std::vector<std::string_view> paper_scene_names() {
  std::vector<std::string_view> names;
  for (const PaperExperiment& experiment : paper_experiments())
    if (names.empty() || names.back() != experiment.scene) names.push_back(experiment.scene);
  return names;
}

void check_wanted(const StudySources& sources, const std::vector<std::string_view>& names) {
  for (const std::string& name : sources.only)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw Error(ErrorCode::kUsage, '"' + name + '"', "is no scene of this study", suggestion(name, names));
}

bool is_wanted(const StudySources& sources, const std::string& scene) {
  return sources.only.empty() || std::find(sources.only.begin(), sources.only.end(), scene) != sources.only.end();
}

bool is_large(const StudyScene& scene) {
  return scene.weight > kLargeWeight;
}

std::string content_of_file(const std::string& path) {
  const std::string bytes = read_whole_file(path);
  return std::to_string(bytes.size()) + ' ' + std::to_string(crc32(bytes));
}

std::string content_of(const TriangleMesh& mesh) {
  const auto bytes_of = [](const auto& values) {
    return std::string_view(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
  };
  return std::to_string(mesh.triangle_count()) + ' ' + std::to_string(crc32(bytes_of(mesh.vertices))) + ' ' +
         std::to_string(crc32(bytes_of(mesh.triangles)));
}

std::string contents_of(const std::vector<StudyScene>& scenes) {
  std::string text;
  for (const StudyScene& scene : scenes)
    if (!scene.content.empty()) text += ' ' + scene.name + ' ' + scene.content;
  return text;
}

TriangleMesh load_scaled(const std::string& path, float scale) {
  TriangleMesh mesh = load_scene(path).mesh;
  if (scale != 1)
    for (Vec3& vertex : mesh.vertices) vertex = vertex * scale;
  return mesh;
}

StudyScene procedural_scene(const std::string& text, const std::string& name) {
  const Scene scene = generate_scene(parse_procedural(text));
  StudyScene result{name,
                    [text] { return generate_scene(parse_procedural(text)).mesh; },
                    {},
                    static_cast<double>(scene.mesh.triangle_count()) / 1000};
  for (const InfluenceArea& area : scene.areas) result.areas.push_back({area.name, area});
  return result;
}

std::vector<StudyScene> paper_scenes(const StudySources& sources, std::vector<std::string>& missing,
                                     const std::vector<StudyScene>& extra) {
  std::vector<std::string_view> names = paper_scene_names();
  for (const StudyScene& scene : extra) names.push_back(scene.name);
  check_wanted(sources, names);
  std::vector<StudyScene> scenes;
  std::string_view left_out;
  for (const PaperExperiment& experiment : paper_experiments()) {
    const std::string name(experiment.scene);
    if (!is_wanted(sources, name) || experiment.scene == left_out) continue;
    std::string path(experiment.source);
    const bool is_file = !path.starts_with("procedural:");
    if (is_file) {
      path = sources.scenes.empty() ? std::string{} : (std::filesystem::path(sources.scenes) / path).string();
      std::error_code none;
      if (path.empty() || !std::filesystem::is_regular_file(path, none)) {
        left_out = experiment.scene;
        missing.push_back(name + ": needs " + std::string(experiment.source) +
                          (sources.scenes.empty() ? "; name its folder with --scenes" : " in " + sources.scenes));
        continue;
      }
    }
    if (scenes.empty() || scenes.back().name != name)
      scenes.push_back({name,
                        [path, scale = experiment.scale] { return load_scaled(path, scale); },
                        {},
                        weight_of(experiment.scene),
                        is_file ? content_of_file(path) : std::string{}});
    const std::string variant(experiment.variant);
    scenes.back().areas.push_back({variant, InfluenceArea{variant, experiment.shape}});
  }
  return scenes;
}

}  // namespace raygrain::study

// Where the rays of the benchmark fly: built-in scenes in two sizes, and models from a folder.
#include <algorithm>
#include <filesystem>
#include <set>

#include "raygrain/error.h"
#include "raygrain/io.h"
#include "raygrain/scene.h"

#include "suite.h"

namespace raygrain::bench {
namespace {

constexpr size_t kLarge = 400000, kHuge = 3000000;  // triangles

std::vector<std::string> models(const std::string& folder) {
  static const std::set<std::string> kKnown{".ply", ".obj", ".stl", ".gltf", ".glb"};
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (kKnown.contains(entry.path().extension().string())) files.push_back(entry.path().string());
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<std::string> scene_sources(const Settings& settings) {
  std::vector<std::string> sources{"procedural:city?size=15", "procedural:forest?size=16",
                                   "procedural:terrain?size=224"};
  if (!settings.quick) {
    sources.insert(sources.end(),
                   {"procedural:city?size=48", "procedural:forest?size=49", "procedural:terrain?size=708"});
    if (!settings.scenes.empty()) {
      const std::vector<std::string> files = models(settings.scenes);
      sources.insert(sources.end(), files.begin(), files.end());
    }
  }
  std::erase_if(sources, [&](const std::string& s) { return s.find(settings.filter) == std::string::npos; });
  return sources;
}

BenchScene load_bench_scene(const std::string& source) {
  Scene scene = load_scene(source);
  std::string name = std::filesystem::path(source).filename().string();
  if (source.starts_with("procedural:")) {
    name = source.substr(source.find(':') + 1);
    const size_t count = scene.mesh.triangle_count();
    name = name.substr(0, name.find('?')) + (count > kHuge ? " 4M" : (count > kLarge ? " 1M" : " 100k"));
  }
  return {name, std::move(scene.mesh)};
}

}  // namespace raygrain::bench

// raygrain-bench: raygrain against Embree, or alone where the build found no Embree.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "base/parallel.h"
#include "suite.h"

namespace raygrain::bench {

std::vector<std::string> scene_sources(const Settings& settings) {
  std::vector<std::string> sources{"procedural:city?size=15", "procedural:forest?size=16",
                                   "procedural:terrain?size=224"};
  if (!settings.quick) {
    sources.insert(sources.end(),
                   {"procedural:city?size=48", "procedural:forest?size=49", "procedural:terrain?size=708"});
    std::vector<std::string> files;
    if (!settings.scenes.empty() && std::filesystem::is_directory(settings.scenes))
      for (const auto& entry : std::filesystem::directory_iterator(settings.scenes))
        if (entry.path().extension() == ".ply" || entry.path().extension() == ".obj")
          files.push_back(entry.path().string());
    std::ranges::sort(files);
    sources.insert(sources.end(), files.begin(), files.end());
  }
  std::erase_if(sources, [&](const std::string& s) { return s.find(settings.filter) == std::string::npos; });
  return sources;
}

BenchScene load_bench_scene(const std::string& source) {
  Scene scene = load_scene(source);
  const size_t colon = source.find(':');
  std::string name = std::filesystem::path(source).filename().string();
  if (source.starts_with("procedural:")) {
    name = source.substr(colon + 1);
    name = name.substr(0, name.find('?')) + (scene.mesh.triangle_count() > 400000 ? " 1M" : " 100k");
  }
  return {name, std::move(scene.mesh)};
}

int run(int argc, char** argv) {
  Settings settings;
  std::string suite = "all";
  CLI::App app{"raygrain against Embree's best modes, on the same rays"};
  app.add_option("--suite", suite, "general, rays or all")->check(CLI::IsMember({"general", "rays", "all"}));
  app.add_flag("--quick", settings.quick, "three small scenes, fewer rays");
  settings.scenes = "../shared/scenes";
  app.add_option("--scenes", settings.scenes, "a folder with more .ply and .obj scenes");
  app.add_option("--only", settings.filter, "only scenes whose source holds this text");
  app.add_option("--json", settings.json, "write all figures to this file");
  app.add_option("--threads", settings.threads, "thread counts; default 1 and all");
  CLI11_PARSE(app, argc, argv);
  if (settings.threads.empty()) settings.threads = {1};
  if (app.count("--threads") == 0 && default_threads() > 1) settings.threads.push_back(default_threads());

  Results results;
  if (suite != "rays")
    for (const std::string& source : scene_sources(settings)) run_general(load_bench_scene(source), settings, results);
  print_summary(results);
  if (!settings.json.empty()) save_json(results, settings.json);
  return 0;
}

}  // namespace raygrain::bench

int main(int argc, char** argv) {
  try {
    return raygrain::bench::run(argc, argv);
  } catch (const raygrain::Error& error) {
    std::fprintf(stderr, "raygrain-bench: error: %s\n", error.what());
    return error.code == raygrain::ErrorCode::kUsage ? 2 : 1;
  }
}

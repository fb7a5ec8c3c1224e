// raygrain-bench: raygrain against Embree's best modes. Without Embree it shows raygrain alone.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "raygrain/error.h"

#include "base/parallel.h"
#include "peer.h"
#include "suite.h"

namespace raygrain::bench {

std::vector<Suite> suites() {
  return {{"general", run_general},
          {"rays", run_rays},
          {"structures", run_structures},
          {"sizes", run_sizes},
          {"builds", run_builds}};
}

namespace {

constexpr const char* kDefaultScenes = "../shared/scenes";

std::vector<std::string> suite_names() {
  std::vector<std::string> names{"all"};
  for (const Suite& suite : suites()) names.emplace_back(suite.name);
  return names;
}

/// A folder that was asked for must be there; the default one may be missing.
void check_scenes(Settings& settings, bool is_given) {
  if (std::filesystem::is_directory(settings.scenes)) return;
  if (is_given) throw Error(ErrorCode::kNotFound, settings.scenes, "is no folder", "give --scenes a folder of models");
  settings.scenes.clear();
}

void check_threads(Settings& settings) {
  if (settings.threads.empty()) {
    settings.threads = {1};
    if (default_threads() > 1) settings.threads.push_back(default_threads());
  }
  if (std::ranges::count(settings.threads, 0u) > 0) throw Error(ErrorCode::kUsage, "--threads", "must be at least 1");
}

int run(int argc, char** argv) {
  Settings settings;
  std::string wanted = "all";
  CLI::App app{"raygrain against Embree's best modes, on the same rays"};
  app.add_option("--suite", wanted, "which figures")->check(CLI::IsMember(suite_names()))->capture_default_str();
  app.add_flag("--quick", settings.quick, "small scenes, fewer rays");
  settings.scenes = kDefaultScenes;
  app.add_option("--scenes", settings.scenes, "a folder with more scenes (not with --quick)")->capture_default_str();
  app.add_option("--only", settings.filter, "only scenes whose source holds this text");
  app.add_option("--json", settings.json, "write all figures to this file");
  app.add_option("--threads", settings.threads, "thread counts; default 1 and all");
  settings.sizes = {1, 10, 100, 1000, 10000, 100000, 1000000};
  app.add_option("--sizes", settings.sizes, "rays a call, of the suite `sizes`")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (settings.quick && app.count("--sizes") == 0) settings.sizes = {1, 10, 100, 1000, 10000, 100000};
  if (std::ranges::count(settings.sizes, 0u) > 0) throw Error(ErrorCode::kUsage, "--sizes", "must be at least 1");
  check_scenes(settings, app.count("--scenes") > 0);
  check_threads(settings);
  if (!Peer::is_there()) std::puts("Embree 3 was not there at build time: raygrain alone");
  Results results;
  for (const Suite& suite : suites())
    if (wanted == "all" || wanted == suite.name) suite.run(settings, results);
  print_summary(results);
  if (!settings.json.empty()) save_json(results, settings.json);
  return 0;
}

}  // namespace
}  // namespace raygrain::bench

int main(int argc, char** argv) {
  try {
    return raygrain::bench::run(argc, argv);
  } catch (const raygrain::Error& error) {
    std::fprintf(stderr, "raygrain-bench: error: %s\n", error.what());
    return error.code == raygrain::ErrorCode::kUsage ? 2 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "raygrain-bench: error: %s\n", error.what());
    return 1;
  }
}

// Which structure pays: coverage, trees of areas in ray space and in the world, and the global tree, each alone on the
// same rays; two levels of cells beside flat grids. All take turns in one race, with Embree's best modes.
#include <algorithm>
#include <cstring>
#include <map>

#include "area_structures.h"
#include "peer.h"
#include "race_whole.h"
#include "structure_rows.h"
#include "suite.h"

namespace raygrain::bench {
namespace {

constexpr size_t kLarge = 400000;  // triangles
constexpr int kRounds = 3;
constexpr int kBuilds = 3;  // of small scenes

/// The sets that are raced, those of the same areas together.
const std::vector<std::vector<std::string>> kSets{{"sun_any", "sun_closest_shuffled"},
                                                  {"point_any"},
                                                  {"pinhole_closest_shuffled"},
                                                  {"disc_any_0.27"},
                                                  {"disc_any_5"}};

size_t count_unlike(bool any, const Answers& a, const Answers& b) {
  size_t unlike = 0;
  for (size_t i = 0; i < a.flags.size(); ++i)
    unlike += any ? a.flags[i] != b.flags[i] : std::memcmp(&a.hits[i], &b.hits[i], sizeof(Hit)) != 0;
  return unlike;
}

class StructuresSuite {
 public:
  StructuresSuite(const BenchScene& scene, const Settings& settings, Results& results)
      : scene_(scene), settings_(settings), results_(results), peer_(scene.mesh) {}

  void run() {
    for (StructuredRays& rays : structured_ray_sets(scene_.mesh, settings_.quick ? 50000 : 200000)) {
      const std::string name = rays.set.name;
      if (!rays.set.rays.empty()) sets_.emplace(name, std::move(rays));
    }
    for (const unsigned threads : settings_.threads) {
      SceneStructures shared(scene_.mesh, threads);
      for (const std::vector<std::string>& names : kSets)
        if (sets_.contains(names.front())) run_areas(shared, names, threads);
    }
  }

 private:
  void run_areas(SceneStructures& shared, const std::vector<std::string>& names, unsigned threads) {
    AreaStructures own(shared, sets_.at(names.front()), threads);
    const int builds = is_large() || settings_.quick ? 1 : kBuilds;
    for (int round = 0; round < builds; ++round) {
      shared.build_again();
      own.build();
    }
    for (const std::string& name : names)
      if (const auto rays = sets_.find(name); rays != sets_.end()) measure(own, shared, rays->second, threads);
  }

  void measure(const AreaStructures& own, const SceneStructures& shared, const StructuredRays& rays, unsigned threads) {
    const std::vector<Structure> structures = own.structures(rays);
    const std::vector<PeerMode> modes = peer_.best_modes(rays.set, threads);
    std::vector<Contestant> all;
    const auto add = [&](std::function<void(Answers&)> trace) {
      all.push_back({std::move(trace), std::make_unique<Answers>(rays.set.rays.size())});
    };
    for (const Structure& structure : structures) add(structure.trace);
    for (const PeerMode& mode : modes)
      add([&](Answers& answers) {
        peer_.trace(mode, rays.set.any, Part(rays.set, answers, 0, rays.set.rays.size()), threads);
      });
    race_whole(all, kRounds, threads);
    StructureRow row = new_row(rays, threads);
    add_peer_figures(modes, std::span(all).subspan(structures.size()), row);
    row.global_build_seconds = shared.cost.seconds;
    row.global_bytes = shared.cost.bytes;
    report_all(structures, all, row);
  }

  void report_all(const std::vector<Structure>& structures, const std::vector<Contestant>& raced, StructureRow row) {
    for (size_t i = 0; i < structures.size(); ++i) {
      row.structure = structures[i].name;
      row.api = structures[i].api;
      row.nanoseconds = nanoseconds(raced[i]);
      row.build_seconds = structures[i].cost.seconds;
      row.memory_bytes = structures[i].cost.bytes;
      row.differences = count_unlike(row.query == "any", *raced[0].answers, *raced[i].answers);
      report(row, results_);
    }
  }

  bool is_large() const { return scene_.mesh.triangle_count() >= kLarge; }

  StructureRow new_row(const StructuredRays& rays, unsigned threads) const {
    StructureRow row;
    row.scene = scene_.name;
    row.triangles = scene_.mesh.triangle_count();
    row.rays = rays.set.name;
    row.query = rays.set.any ? "any" : "closest";
    row.threads = threads;
    return row;
  }

  static double nanoseconds(const Contestant& contestant) {
    return contestant.seconds * 1e9 / static_cast<double>(contestant.answers->flags.size());
  }

  static void add_peer_figures(const std::vector<PeerMode>& modes, std::span<const Contestant> raced,
                               StructureRow& row) {
    const auto keep = [](double time, const PeerMode& mode, double& least, std::string& name) {
      if (least == 0 || time < least) least = time, name = mode.name();
    };
    for (size_t i = 0; i < modes.size(); ++i) {
      const double time = nanoseconds(raced[i]);
      keep(time, modes[i], row.embree_best_nanoseconds, row.embree_best_mode);
      if (modes[i].packet == 1) keep(time, modes[i], row.embree_single_nanoseconds, row.embree_single_mode);
    }
  }

  const BenchScene& scene_;
  const Settings& settings_;
  Results& results_;
  Peer peer_;
  std::map<std::string, StructuredRays> sets_;
};

}  // namespace

void run_structures(const Settings& settings, Results& results) {
  for (const std::string& source : scene_sources(settings)) {
    const BenchScene scene = load_bench_scene(source);
    StructuresSuite(scene, settings, results).run();
  }
  print_structure_tables(results.structures);
}

}  // namespace raygrain::bench

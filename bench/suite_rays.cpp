// Rays with structure, through accelerators that know them, against Embree: on the rays as they come, and on rays
// sorted for it, with the time for sorting.
#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "area_builds.h"
#include "measure.h"
#include "peer.h"
#include "ray_sorting.h"
#include "rays_rows.h"
#include "turned_rays.h"

namespace raygrain::bench {
namespace {

constexpr int kRounds = 5;
constexpr size_t kSortedModes = 2;

bool same_answer(bool any, const Answers& a, const Answers& b, size_t i) {
  return any ? a.flags[i] == b.flags[i] : a.hits[i] == b.hits[i];
}

void check_agreement(const StructuredRays& rays, const Answers& a, const Answers& b) {
  for (size_t i = 0; i < rays.set.rays.size(); ++i)
    if (!same_answer(rays.set.any, a, b, i))
      throw std::logic_error("raygrain's interfaces disagree about ray " + std::to_string(i) + " of " + rays.set.name);
}

/// One set on one count of threads. Ours: batch, single, and the global tree alone by both; then the peer's modes on
/// rays as given, then on sorted ones.
class SetRace {
 public:
  SetRace(const BenchScene& scene, const StructuredRays& rays, const Peer& peer, unsigned threads)
      : scene_(scene),
        rays_(rays),
        peer_(peer),
        threads_(threads),
        sorter_(rays, threads),
        found_(rays.set.rays.size()) {}

  void run(const Accelerator& ours, const AreaBuildRow& build, Results& results) {
    // The same global tree: where a tree lies in memory may change its speed by a tenth.
    const Accelerator global = ours.with_local_trees({});
    add([&](Answers& a) { trace_batch(ours, rays_, a, threads_); });
    add([&](Answers& a) { trace_singly(ours, rays_, a, threads_); });
    add([&](Answers& a) { trace_array(global, rays_, a, threads_); });
    add([&](Answers& a) { trace_singly(global, rays_, a, threads_); });
    add_peer();
    race_whole(all_, kRounds, threads_);
    for (size_t k = 1; k < kOurs; ++k) check_agreement(rays_, *all_[0].answers, *all_[k].answers);

    Row row = structured_row(scene_, rays_, threads_);
    row.tree = ours.coverages().empty() ? "tree" : "coverage and tree";
    row.area_build = build;
    const Answers* best_single = add_peer_figures(row);
    report(row_of("batch", 0, build, row), results);
    row.sorted_differences.reset();
    row.differences = differences_from(best_single, 1);
    report(row_of("single", 1, build, row), results);
  }

 private:
  static constexpr size_t kOurs = 4;

  void add(std::function<void(Answers&)> trace) { all_.push_back(contestant(rays_, std::move(trace))); }

  void add_peer() {
    modes_ = peer_.best_modes(rays_.set, threads_);
    sorted_modes_ = peer_.best_modes(sorter_.sort(), threads_);
    sorted_modes_.resize(std::min(kSortedModes, sorted_modes_.size()));
    for (const PeerMode& mode : modes_) add([&](Answers& a) { trace_peer(mode, rays_.set, a); });
    for (const PeerMode& mode : sorted_modes_)
      add([&](Answers& a) {
        trace_peer(mode, sorter_.sort(), found_);
        sorter_.unsort(found_, a);
      });
  }

  void trace_peer(const PeerMode& mode, const BenchRays& set, Answers& answers) const {
    peer_.trace(mode, set.any, Part(set, answers, 0, set.rays.size()), threads_);
  }

  /// Returns the answers of its best single-ray mode.
  const Answers* add_peer_figures(Row& row) const {
    const Answers *best = nullptr, *single = nullptr, *sorted = nullptr;
    const auto keep_best = [&](size_t i, const PeerMode& mode, double& mrays_of_best, std::string& name,
                               const Answers*& answers) {
      const double speed = mrays(rays_, all_[i].seconds);
      if (speed > mrays_of_best) mrays_of_best = speed, name = mode.name(), answers = all_[i].answers.get();
    };
    for (size_t i = 0; i < modes_.size(); ++i) {
      keep_best(kOurs + i, modes_[i], row.embree_best_mrays, row.embree_best_mode, best);
      if (modes_[i].packet == 1)
        keep_best(kOurs + i, modes_[i], row.embree_single_mrays, row.embree_single_mode, single);
    }
    for (size_t i = 0; i < sorted_modes_.size(); ++i)
      keep_best(kOurs + modes_.size() + i, sorted_modes_[i], row.embree_sorted_mrays, row.embree_sorted_mode, sorted);
    row.differences = differences_from(best, 0);
    row.sorted_differences = differences_from(sorted, 0);
    return single;
  }

  std::optional<Differences> differences_from(const Answers* theirs, size_t ours) const {
    if (theirs == nullptr) return {};
    return count_differences(scene_.mesh, rays_.set, *all_[ours].answers, *theirs);
  }

  /// Of our interface `ours`; its global tree alone comes two later.
  Row row_of(const char* api, size_t ours, const AreaBuildRow& build, Row row) const {
    const double seconds = all_[ours].seconds, global_seconds = all_[ours + 2].seconds;
    row.api = api;
    row.raygrain_mrays = mrays(rays_, seconds);
    row.global_mrays = mrays(rays_, global_seconds);
    const double saved = (global_seconds - seconds) / static_cast<double>(rays_.set.rays.size());
    row.break_even_rays = saved > 0 ? build.build_seconds / saved : std::numeric_limits<double>::infinity();
    return row;
  }

  const BenchScene& scene_;
  const StructuredRays& rays_;
  const Peer& peer_;
  const unsigned threads_;
  RaySorter sorter_;
  Answers found_;  // by the peer, for sorted rays
  std::vector<PeerMode> modes_, sorted_modes_;
  std::vector<Contestant> all_;
};

void run_sets(const BenchScene& scene, const Settings& settings, Results& results) {
  const std::vector<StructuredRays> sets = structured_ray_sets(scene.mesh, settings.quick ? 100000 : 400000);
  const std::vector<AreaBuildRow> builds = measure_area_builds(scene, sets, settings.threads);
  for (const AreaBuildRow& row : builds) report(row, results);
  const Peer peer(scene.mesh);
  for (const StructuredRays& rays : sets) {
    if (rays.set.rays.empty()) continue;
    const Accelerator ours(scene.mesh, rays.areas, rays_options());
    for (const AreaBuildRow& build : builds)
      if (build.structure == rays.structure) SetRace(scene, rays, peer, build.threads).run(ours, build, results);
  }
}

}  // namespace

void run_rays(const Settings& settings, Results& results) {
  for (const std::string& source : scene_sources(settings)) {
    const BenchScene scene = load_bench_scene(source);
    run_sets(scene, settings, results);
    run_turned(scene, settings, results);
  }
}

}  // namespace raygrain::bench

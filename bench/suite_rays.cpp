// Rays with structure, through accelerators that know them, against Embree: on the rays as they come, and on rays
// sorted for it, with the time for sorting.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "raygrain/trace.h"

#include "base/random.h"
#include "base/timer.h"
#include "measure.h"
#include "peer.h"
#include "race_whole.h"
#include "structured_rays.h"
#include "suite.h"

namespace raygrain::bench {
namespace {

constexpr int kRounds = 5;
constexpr int kTurns = 20, kTurnedRounds = 15;

/// The accelerators of this suite.
AcceleratorOptions bench_options() {
  AcceleratorOptions options;
  options.quality = Quality::kBalanced;
  options.space = LocalSpace::kNone;  // as docs/performance-rays.md found it best
  return options;
}

bool same_answer(bool any, const Answers& a, const Answers& b, size_t i) {
  return any ? a.flags[i] == b.flags[i] : a.hits[i] == b.hits[i];
}

/// An accelerator of a set's areas, and what its areas cost beyond the global tree.
struct Specialised {
  Accelerator accelerator;
  double build_seconds = 0;
  size_t memory_bytes = 0;
};

Specialised specialise(const TriangleMesh& mesh, const Accelerator& global, double global_seconds,
                       const std::vector<InfluenceArea>& areas) {
  TriangleMesh copy = mesh;
  const Timer timer;
  Accelerator accelerator(std::move(copy), areas, bench_options());
  const double seconds = std::max(0.0, timer.seconds() - global_seconds);
  const size_t bytes = accelerator.memory_bytes() - global.memory_bytes();
  return {std::move(accelerator), seconds, bytes};
}

/// A scene as it was turned, or under another sun.
struct Turned {
  std::string name;
  int turn = 0;
  StructuredRays rays;
  Accelerator global;
  Specialised ours;
};

class RaysSuite {
 public:
  RaysSuite(const BenchScene& scene, const Settings& settings, Results& results)
      : scene_(scene), settings_(settings), results_(results), peer_(scene.mesh), global_(make_global()) {}

  void run() {
    for (const StructuredRays& rays : structured_ray_sets(scene_.mesh, settings_.quick ? 100000 : 400000)) {
      if (rays.set.rays.empty()) continue;
      const Specialised ours = specialise(scene_.mesh, global_, global_seconds_, rays.areas);
      for (const unsigned threads : settings_.threads) measure_set(rays, ours, threads);
    }
    if (scene_.mesh.triangle_count() < kMostTurned) run_turned();
  }

 private:
  static constexpr size_t kMostTurned = 300000;  // triangles: 40 accelerators are there at once, some 2 GB

  Accelerator make_global() {
    TriangleMesh copy = scene_.mesh;
    const Timer timer;
    Accelerator global(std::move(copy), {}, bench_options());
    global_seconds_ = timer.seconds();
    return global;
  }

  Row new_row(const StructuredRays& rays, unsigned threads) const {
    Row row;
    row.suite = "rays";
    row.scene = scene_.name;
    row.triangles = scene_.mesh.triangle_count();
    row.rays = rays.set.name;
    row.query = rays.set.any ? "any" : "closest";
    row.threads = threads;
    return row;
  }

  Contestant contestant(const StructuredRays& rays, std::function<void(Answers&)> trace) const {
    return {std::move(trace), std::make_unique<Answers>(rays.set.rays.size()), std::numeric_limits<double>::infinity()};
  }

  void trace_peer(const PeerMode& mode, const BenchRays& set, Answers& answers, unsigned threads) const {
    peer_.trace(mode, set.any, Part(set, answers, 0, set.rays.size()), threads);
  }

  /// Ours: batch, single, and the global tree alone by both; then the peer's modes on rays as given, then on sorted.
  void measure_set(const StructuredRays& rays, const Specialised& ours, unsigned threads) {
    // The same global tree: where a tree lies in memory may change its speed by a tenth.
    const Accelerator global = ours.accelerator.with_local_trees({});
    std::vector<Contestant> all;
    all.push_back(contestant(rays, [&](Answers& a) { trace_batch(ours.accelerator, rays, a, threads); }));
    all.push_back(contestant(rays, [&](Answers& a) { trace_singly(ours.accelerator, rays, a, threads); }));
    all.push_back(contestant(rays, [&](Answers& a) { trace_array(global, rays, a, threads); }));
    all.push_back(contestant(rays, [&](Answers& a) { trace_singly(global, rays, a, threads); }));
    const std::vector<PeerMode> modes = peer_.best_modes(rays.set, threads);
    SortedRays sorted;
    sort_rays(rays, threads, sorted);
    const std::vector<PeerMode> sorted_modes = peer_.best_modes(sorted.set, threads);
    for (const PeerMode& mode : modes)
      all.push_back(contestant(rays, [&](Answers& a) { trace_peer(mode, rays.set, a, threads); }));
    for (size_t i = 0; i < std::min<size_t>(2, sorted_modes.size()); ++i)
      all.push_back(contestant(rays, [&, i](Answers& a) {
        SortedRays fresh;
        Answers found(rays.set.rays.size());
        sort_rays(rays, threads, fresh);
        trace_peer(sorted_modes[i], fresh.set, found, threads);
        unsort(fresh, found, rays.set.any, threads, a);
      }));
    race_whole(all, kRounds, threads);
    for (size_t k = 1; k < 4; ++k) check_agreement(rays, *all[0].answers, *all[k].answers);

    Row row = new_row(rays, threads);
    add_peer_figures(rays, all, modes, sorted_modes, row);
    row.build_seconds = ours.build_seconds;
    row.memory_bytes = ours.memory_bytes;
    for (const size_t i : {size_t{0}, size_t{1}}) {
      row.api = i == 0 ? "batch" : "single";
      row.tree = ours.accelerator.coverages().empty() ? "tree" : "coverage and tree";
      row.raygrain_mrays = mrays(rays, all[i].seconds);
      row.global_mrays = mrays(rays, all[i + 2].seconds);
      const double saved = (all[i + 2].seconds - all[i].seconds) / static_cast<double>(rays.set.rays.size());
      row.break_even_rays = saved > 0 ? ours.build_seconds / saved : std::numeric_limits<double>::infinity();
      report(row, results_);
    }
  }

  static double mrays(const StructuredRays& rays, double seconds) {
    return static_cast<double>(rays.set.rays.size()) / seconds * 1e-6;
  }

  void add_peer_figures(const StructuredRays& rays, const std::vector<Contestant>& all,
                        const std::vector<PeerMode>& modes, const std::vector<PeerMode>& sorted_modes, Row& row) const {
    for (size_t i = 0; i < modes.size(); ++i) {
      const double speed = mrays(rays, all[4 + i].seconds);
      if (speed > row.embree_best_mrays) row.embree_best_mrays = speed, row.embree_best_mode = modes[i].name();
      if (modes[i].packet == 1 && speed > row.embree_single_mrays) {
        row.embree_single_mrays = speed;
        row.embree_single_mode = modes[i].name();
      }
    }
    for (size_t i = 4 + modes.size(); i < all.size(); ++i) {
      const double speed = mrays(rays, all[i].seconds);
      if (speed > row.embree_sorted_mrays) {
        row.embree_sorted_mrays = speed;
        row.embree_sorted_mode = sorted_modes[i - 4 - modes.size()].name();
      }
    }
    if (modes.empty()) return;
    count_differences(scene_.mesh, rays.set, *all[0].answers, *all[4].answers, row);
  }

  static void check_agreement(const StructuredRays& rays, const Answers& a, const Answers& b) {
    for (size_t i = 0; i < rays.set.rays.size(); ++i)
      if (!same_answer(rays.set.any, a, b, i))
        throw std::logic_error("raygrain's interfaces disagree about ray " + std::to_string(i) + " of " +
                               rays.set.name);
  }

  /// The scene and its sun turned together, one of them as many times again (what equals differ by on this machine),
  /// and the fixed scene under as many suns: what obliqueness costs.
  void run_turned();
  Turned turn_to(const std::string& name, int turn, const TriangleMesh& mesh, Vec3 light) const;
  void measure_turned(const std::vector<Turned>& all);
  void report_turned(const Turned& t, double our_seconds, double global_seconds);

  const BenchScene& scene_;
  const Settings& settings_;
  Results& results_;
  Peer peer_;
  double global_seconds_ = 0;
  Accelerator global_;
};

/// A rotation from three of uniform numbers, after Shoemake, "Uniform random rotations" (1992).
struct Rotation {
  double w, x, y, z;

  explicit Rotation(int turn) {
    Random random(static_cast<uint64_t>(turn) + 1);
    const double u = random.uniform(), a = 2 * std::numbers::pi * random.uniform();
    const double b = 2 * std::numbers::pi * random.uniform();
    w = std::sqrt(1 - u) * std::sin(a), x = std::sqrt(1 - u) * std::cos(a);
    y = std::sqrt(u) * std::sin(b), z = std::sqrt(u) * std::cos(b);
  }
  Vec3 operator()(Vec3 p) const {
    const Vec3d v = to_double(p), axis{x, y, z};
    const Vec3d twice = cross(axis, v) * 2.0;
    return to_float(v + twice * w + cross(axis, twice));
  }
};

constexpr Vec3 kTurnedSun{-0.42f, -0.85f, 0.31f};

void RaysSuite::run_turned() {
  const int turns = settings_.quick ? 5 : kTurns;
  std::vector<Turned> all;
  for (const std::string name : {"turned", "again"}) {  // `turn` of "again" is the number of the copy
    for (int turn = 0; turn < turns; ++turn) {
      const Rotation rotation(name == "turned" ? turn : 0);
      TriangleMesh turned = scene_.mesh;
      for (Vec3& v : turned.vertices) v = rotation(v);
      all.push_back(turn_to(name, turn, turned, rotation(kTurnedSun)));
    }
    measure_turned(all);
    all.clear();
  }
  for (int turn = 0; turn < turns; ++turn) {
    Vec3 light = Rotation(turn)(kTurnedSun);
    light.y = -std::abs(light.y) - 0.05f;  // from above
    all.push_back(turn_to("directions", turn, scene_.mesh, light));
  }
  measure_turned(all);
}

Turned RaysSuite::turn_to(const std::string& name, int turn, const TriangleMesh& mesh, Vec3 light) const {
  StructuredRays rays = sun_rays(mesh, light, settings_.quick ? 50000 : 100000);
  Accelerator global(mesh, {}, bench_options());
  Specialised ours = specialise(mesh, global, 0, rays.areas);
  return {name, turn, std::move(rays), std::move(global), std::move(ours)};
}

/// All take turns, so that a machine that becomes slower meanwhile does not set them apart.
void RaysSuite::measure_turned(const std::vector<Turned>& all) {
  std::vector<Contestant> contestants;
  for (const Turned& t : all) {
    contestants.push_back(contestant(t.rays, [&](Answers& a) { trace_batch(t.ours.accelerator, t.rays, a, 1); }));
    contestants.push_back(contestant(t.rays, [&](Answers& a) { trace_array(t.global, t.rays, a, 1); }));
  }
  race_whole(contestants, kTurnedRounds, 1);
  for (size_t i = 0; i < all.size(); ++i)
    report_turned(all[i], contestants[2 * i].seconds, contestants[2 * i + 1].seconds);
}

void RaysSuite::report_turned(const Turned& t, double our_seconds, double global_seconds) {
  const StructuredRays& rays = t.rays;
  Row row = new_row(rays, 1);
  row.rays = t.name;
  row.api = "batch";
  row.turn = t.turn;
  row.raygrain_mrays = mrays(rays, our_seconds);
  row.global_mrays = mrays(rays, global_seconds);
  row.memory_bytes = t.ours.memory_bytes;
  CoverageCounters counters;
  std::vector<uint32_t> rest;
  Answers answers(rays.set.rays.size());
  t.ours.accelerator.coverages()[0].occluded(rays.points, rays.common, answers.flags, rest, {}, 1, &counters);
  AcceleratorCounters world;
  t.global.occluded(rays.set.rays, answers.flags, 1, &world);
  const auto per_ray = [&](uint64_t n) { return static_cast<double>(n) / static_cast<double>(rays.set.rays.size()); };
  // A cell counts as a node; the paper's constants.
  row.cost = 2 + 1.2 * per_ray(counters.triangle_tests);
  row.global_cost = 2 * per_ray(world.global.inner_hits) + 1.2 * per_ray(world.global.leaf_triangles);
  report(row, results_);
}

}  // namespace

void run_rays(const Settings& settings, Results& results) {
  for (const std::string& source : scene_sources(settings)) {
    const BenchScene scene = load_bench_scene(source);
    RaysSuite(scene, settings, results).run();
  }
}

}  // namespace raygrain::bench

// Ordinary rays: raygrain's wide tree and Embree in its best modes, interleaved, the least of several times each.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <span>

#include "raygrain/analyze.h"
#include "raygrain/build.h"
#include "raygrain/trace.h"
#include "raygrain/wide.h"

#include "base/parallel.h"
#include "base/timer.h"
#include "ray_sets.h"
#include "suite.h"

#ifdef RAYGRAIN_BENCH_EMBREE
#include "embree_engine.h"
#endif

namespace raygrain::bench {
namespace {

constexpr int kRounds = 7;
constexpr size_t kRaysPerTask = 1024;

struct Answers {
  std::vector<Hit> hits;
  std::vector<uint8_t> flags;

  explicit Answers(size_t count) : hits(count), flags(count) {}
};

/// Answers the rays begin ... end - 1 of a set.
using Contender = std::function<void(size_t begin, size_t end)>;

/// Seconds of each. All take turns on every part of the set, kRounds times over the whole set, and the least time for
/// each part counts: other programs disturb a short part less often than a long one. Before its turn each traces
/// another part untimed: what is in the caches is its own, but not from these rays.
std::vector<double> race(const std::vector<Contender>& contenders, size_t rays, unsigned threads) {
  const size_t part = size_t{4096} * (threads == 1 ? 1 : 8 * threads);
  const size_t parts = (rays + part - 1) / part;
  std::vector<std::vector<double>> least(contenders.size(),
                                         std::vector<double>(parts, std::numeric_limits<double>::infinity()));
  for (int round = 0; round < kRounds; ++round)
    for (size_t p = 0; p < parts; ++p)
      for (size_t i = 0; i < contenders.size(); ++i) {
        const size_t before = (p + parts - 1) % parts;
        contenders[i](before * part, std::min(rays, (before + 1) * part));  // its own tree into the caches
        const Timer timer;
        contenders[i](p * part, std::min(rays, (p + 1) * part));
        least[i][p] = std::min(least[i][p], timer.seconds());
      }
  std::vector<double> seconds;
  for (const std::vector<double>& times : least) seconds.push_back(std::accumulate(times.begin(), times.end(), 0.0));
  return seconds;
}

/// The part of a set and of its answers that a contender works on.
struct Part {
  std::span<const Ray> rays;
  std::span<Hit> hits;
  std::span<uint8_t> flags;

  Part(const BenchRays& set, Answers& answers, size_t begin, size_t end)
      : rays(std::span(set.rays).subspan(begin, end - begin)),
        hits(std::span(answers.hits).subspan(begin, end - begin)),
        flags(std::span(answers.flags).subspan(begin, end - begin)) {}
};

void trace_array(const WideBvh& tree, bool any, const Part& part, unsigned threads) {
  if (any)
    tree.occluded(part.rays, part.flags, threads);
  else
    tree.intersect(part.rays, part.hits, threads);
}

void trace_singly(const WideBvh& tree, bool any, const Part& part, unsigned threads) {
  parallel_for(part.rays.size(), kRaysPerTask, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (any)
        part.flags[i] = tree.occluded(part.rays[i]);
      else
        part.hits[i] = tree.intersect(part.rays[i]);
    }
  });
}

Bvh build_balanced(const TriangleMesh& mesh) {
  BuildOptions options;
  options.parameters.bins = 32;
  options.parameters.max_levels = 64;
  const std::vector<Bounds> bounds = triangle_bounds(mesh);
  std::vector<Vec3> centers(bounds.size());  // of the boxes: better trees than with the triangles' barycentres
  std::ranges::transform(bounds, centers.begin(), [](const Bounds& box) { return center(box); });
  return build_binned(bounds, centers, options);
}

struct Built {
  WideBvh tree;
  BuildRow row;
};

Built build(const BenchScene& scene, unsigned threads) {
  const Timer timer;
  const Bvh binary = build_balanced(scene.mesh);
  WideBvh tree(binary, scene.mesh);
  BuildRow row{scene.name, scene.mesh.triangle_count(), "balanced", threads, timer.seconds(), 0, "", 0, 0, 0};
  row.raygrain_bytes = tree.memory_bytes();
  row.sah_cost = analyze(binary, RayMeasure()).estimated_cost;
  return {std::move(tree), row};
}

#ifdef RAYGRAIN_BENCH_EMBREE
class EmbreeSide {
 public:
  explicit EmbreeSide(const TriangleMesh& mesh, unsigned threads) {
    for (const bool high : {false, true})
      for (const bool robust : {false, true})
        scenes_[{high, robust}] = std::make_unique<EmbreeScene>(mesh, high, robust, threads);
  }
  void trace(const EmbreeMode& mode, bool any, const Part& part, unsigned threads) const {
    const EmbreeScene& scene = *scenes_.at({mode.high, mode.robust});
    if (any)
      scene.occluded(mode, part.rays, part.flags, threads);
    else
      scene.intersect(mode, part.rays, part.hits, threads);
  }
  const EmbreeScene& scene(bool high) const { return *scenes_.at({high, false}); }

  /// Those to race: the two fastest of any kind, and the fastest for single rays, on the beginning of the set.
  std::vector<EmbreeMode> best_modes(const BenchRays& set, unsigned threads) const {
    const size_t count = std::min<size_t>(50000, set.rays.size());
    Answers answers(set.rays.size());
    std::vector<std::pair<double, EmbreeMode>> ranking;
    for (const EmbreeMode& mode : embree_modes()) {
      double least = std::numeric_limits<double>::infinity();
      for (int round = 0; round < 2; ++round) {
        const Timer timer;
        trace(mode, set.any, Part(set, answers, 0, count), threads);
        least = std::min(least, timer.seconds());
      }
      ranking.emplace_back(least, mode);
    }
    std::ranges::stable_sort(ranking, {}, &std::pair<double, EmbreeMode>::first);
    std::vector<EmbreeMode> best{ranking[0].second, ranking[1].second};
    int singles = 0;
    for (const auto& [seconds, mode] : ranking)
      if (mode.packet == 1 && singles++ < 2) best.push_back(mode);
    return best;
  }

 private:
  std::map<std::pair<bool, bool>, std::unique_ptr<EmbreeScene>> scenes_;
};

/// Hits whose t agree within rounding are the same; which of two triangles at a common edge is named is not compared.
bool differ(const BenchRays& set, const Answers& a, const Answers& b, size_t i) {
  if (set.any) return a.flags[i] != b.flags[i];
  const Hit &x = a.hits[i], &y = b.hits[i];
  if (is_hit(x) != is_hit(y)) return true;
  return is_hit(x) && x.triangle != y.triangle && std::abs(x.t - y.t) > 1e-4f * std::max(std::abs(x.t), 1e-3f);
}

void count_differences(const BenchScene& scene, const BenchRays& set, const Answers& ours, const Answers& theirs,
                       Row& row) {
  for (size_t i = 0; i < set.rays.size(); ++i) {
    if (!differ(set, ours, theirs, i)) continue;
    ++row.differences;
    if (row.oracle_asked == 10) continue;
    ++row.oracle_asked;
    row.oracle_agrees += set.any ? occluded_reference(scene.mesh, set.rays[i]) == (ours.flags[i] != 0)
                                 : intersect_reference(scene.mesh, set.rays[i]) == ours.hits[i];
  }
}
#endif

class GeneralSuite {
 public:
  GeneralSuite(const BenchScene& scene, const Settings& settings, Results& results)
      : scene_(scene), settings_(settings), results_(results) {}

  void run() {
    Built built = build(scene_, 1);
#ifdef RAYGRAIN_BENCH_EMBREE
    embree_ = std::make_unique<EmbreeSide>(scene_.mesh, 1);
    built.row.embree_seconds = embree_->scene(false).build_seconds();
    built.row.embree_bytes = embree_->scene(false).memory_bytes();
    built.row.embree_quality = "medium";
#endif
    results_.builds.push_back(built.row);
    const size_t count = settings_.quick ? 50000 : 250000;
    for (const BenchRays& set : general_ray_sets(scene_.mesh, built.tree, count))
      for (const unsigned threads : settings_.threads) measure(built.tree, set, threads);
  }

 private:
  void measure(const WideBvh& tree, const BenchRays& set, unsigned threads) {
    if (set.rays.empty()) return;
    Answers array(set.rays.size()), singles(set.rays.size());
    std::vector<Contender> contenders{
        [&](size_t begin, size_t end) { trace_array(tree, set.any, Part(set, array, begin, end), threads); },
        [&](size_t begin, size_t end) { trace_singly(tree, set.any, Part(set, singles, begin, end), threads); }};
    Row row;
    row.suite = "general";
    row.scene = scene_.name;
    row.triangles = scene_.mesh.triangle_count();
    row.rays = set.name;
    row.query = set.any ? "any" : "closest";
    row.threads = threads;
#ifdef RAYGRAIN_BENCH_EMBREE
    const std::vector<EmbreeMode> modes = embree_->best_modes(set, threads);
    std::vector<Answers> theirs(modes.size(), Answers(set.rays.size()));
    for (size_t i = 0; i < modes.size(); ++i)
      contenders.push_back([&, i](size_t begin, size_t end) {
        embree_->trace(modes[i], set.any, Part(set, theirs[i], begin, end), threads);
      });
#endif
    const std::vector<double> seconds = race(contenders, set.rays.size(), threads);
    const auto mrays = [&](double s) { return static_cast<double>(set.rays.size()) / s * 1e-6; };
#ifdef RAYGRAIN_BENCH_EMBREE
    for (size_t i = 0; i < modes.size(); ++i) {
      const double speed = mrays(seconds[i + 2]);
      if (modes[i].packet == 1) row.embree_single_mrays = std::max(row.embree_single_mrays, speed);
      if (speed <= row.embree_best_mrays) continue;
      row.embree_best_mrays = speed;
      row.embree_best_mode = modes[i].name();
    }
    count_differences(scene_, set, array, theirs.back(), row);
#endif
    for (const size_t i : {size_t{0}, size_t{1}}) {
      row.api = i == 0 ? "array" : "single";
      row.raygrain_mrays = mrays(seconds[i]);
      results_.rows.push_back(row);
      print_row(row);
    }
  }

  const BenchScene& scene_;
  const Settings& settings_;
  Results& results_;
#ifdef RAYGRAIN_BENCH_EMBREE
  std::unique_ptr<EmbreeSide> embree_;
#endif
};

}  // namespace

void run_general(const BenchScene& scene, const Settings& settings, Results& results) {
  GeneralSuite(scene, settings, results).run();
}

}  // namespace raygrain::bench

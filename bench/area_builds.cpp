#include "area_builds.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "presets.h"
#include "stopwatch.h"

namespace raygrain::bench {
namespace {

constexpr size_t kLarge = 400000;  // triangles

/// One set of each structure, whose areas stand for all.
std::vector<const StructuredRays*> one_of_each(std::span<const StructuredRays> sets) {
  std::vector<const StructuredRays*> chosen;
  for (const StructuredRays& set : sets)
    if (std::ranges::find(chosen, set.structure, [](const StructuredRays* s) { return s->structure; }) == chosen.end())
      chosen.push_back(&set);
  return chosen;
}

constexpr double kNever = std::numeric_limits<double>::infinity();

void keep_least(double& least, const Stopwatch& stopwatch) {
  least = std::min(least, stopwatch.seconds());
}

/// A structure's areas together, and each alone.
class AreaTimes {
 public:
  AreaTimes(const StructuredRays& set, const std::shared_ptr<const TriangleMesh>& mesh, const CoverageOptions& options)
      : areas_(set.areas), mesh_(mesh), options_(options), alone_(areas_.size(), kNever), bytes_(areas_.size()) {}

  void build() {
    {
      const Stopwatch stopwatch(options_.threads);
      const std::vector<Coverage> coverages = Coverage::of_areas(mesh_, areas_, options_);
      keep_least(together_, stopwatch);
      for (size_t i = 0; i < areas_.size(); ++i) bytes_[i] = coverages[i].memory_bytes();
    }
    if (areas_.size() == 1) alone_[0] = together_;
    for (size_t i = 0; areas_.size() > 1 && i < areas_.size(); ++i) {
      const Stopwatch stopwatch(options_.threads);
      const Coverage coverage(mesh_, areas_[i], options_);
      keep_least(alone_[i], stopwatch);
    }
  }

  void write(AreaBuildRow& row) const {
    row.build_seconds = together_;
    row.area_build_seconds = std::ranges::max(alone_);
    row.area_memory_bytes = std::ranges::max(bytes_);
  }

 private:
  const std::vector<InfluenceArea>& areas_;
  const std::shared_ptr<const TriangleMesh>& mesh_;
  const CoverageOptions& options_;
  double together_ = kNever;
  std::vector<double> alone_;
  std::vector<size_t> bytes_;
};

void measure_memory(const TriangleMesh& mesh, const StructuredRays& set, const Accelerator& global, AreaBuildRow& row) {
  const Accelerator with(mesh, set.areas, rays_options());
  row.memory_bytes = with.memory_bytes() - global.memory_bytes();
  row.global_memory_bytes = global.memory_bytes();
  row.global_wide_memory_bytes = global.wide_memory_bytes();
}

void measure_times(const TriangleMesh& mesh, const std::vector<const StructuredRays*>& chosen,
                   std::span<AreaBuildRow> rows) {
  const std::shared_ptr<const TriangleMesh> shared(std::shared_ptr<void>(), &mesh);
  const unsigned threads = rows.front().threads;
  CoverageOptions options = rays_options().coverage.value_or(CoverageOptions{});
  options.threads = threads;
  std::vector<AreaTimes> times;
  for (const StructuredRays* set : chosen) times.emplace_back(*set, shared, options);
  double best = kNever;
  const int rounds = mesh.triangle_count() > kLarge ? 3 : 7;
  for (int round = 0; round < rounds; ++round) {
    {
      const Stopwatch stopwatch(threads);
      const Bvh binary = build_preset(mesh, Quality::kBest, threads);
      const WideBvh tree(binary, mesh, {.threads = threads});
      keep_least(best, stopwatch);
    }
    for (AreaTimes& t : times) t.build();
  }
  for (size_t i = 0; i < rows.size(); ++i) times[i].write(rows[i]);
  for (AreaBuildRow& row : rows) row.global_best_build_seconds = best;
}

}  // namespace

AcceleratorOptions rays_options() {
  AcceleratorOptions options;
  options.quality = Quality::kBalanced;
  options.space = LocalSpace::kNone;  // as docs/performance-rays.md found it best
  return options;
}

std::vector<AreaBuildRow> measure_area_builds(const BenchScene& scene, std::span<const StructuredRays> sets,
                                              const std::vector<unsigned>& threads) {
  const std::vector<const StructuredRays*> chosen = one_of_each(sets);
  const Accelerator global(scene.mesh, {}, rays_options());
  std::vector<AreaBuildRow> one_count(chosen.size()), rows;
  for (size_t i = 0; i < chosen.size(); ++i) {
    AreaBuildRow& row = one_count[i];
    row.scene = scene.name;
    row.triangles = scene.mesh.triangle_count();
    row.structure = chosen[i]->structure;
    measure_memory(scene.mesh, *chosen[i], global, row);
  }
  for (const unsigned n : threads) {
    for (AreaBuildRow& row : one_count) row.threads = n;
    measure_times(scene.mesh, chosen, one_count);
    rows.insert(rows.end(), one_count.begin(), one_count.end());
  }
  return rows;
}

}  // namespace raygrain::bench

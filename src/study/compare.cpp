#include "raygrain/compare.h"

#include <algorithm>

#include "base/timer.h"
#include "study/hit_check.h"
#include "study/progress.h"

namespace raygrain {
namespace {

constexpr int kTimedPasses = 3;  // the least time of so many is reported

/// What all recipes of one area share.
struct AreaJob {
  InfluenceArea area;
  AreaGeometry geometry;
  std::vector<Ray> rays, served, samples;
  std::vector<std::vector<Hit>> expected;  // hits by independent searches
};

void check_options(const Scene& scene, const CompareOptions& options) {
  if (scene.areas.empty()) {
    throw Error(ErrorCode::kUsage, scene.name.empty() ? "scene" : scene.name, "has no influence areas to compare for",
                "Add areas to the scene, or name a sun, a light or a camera");
  }
  if (options.rays == 0) throw Error(ErrorCode::kUsage, "rays", "must be at least 1");
}

/// A tree that shares nothing with the compared ones but the box test and the intersector.
Bvh build_check_tree(const TriangleMesh& mesh) {
  PaperParameters parameters;
  parameters.bins = 16;
  return build_global_tree(mesh, Recipe{"SAH", "ROBIN", "binned", parameters}, default_registry());
}

AreaJob make_job(const TriangleMesh& mesh, const InfluenceArea& area, const Bvh& check, const CompareOptions& options) {
  AreaJob job{area, AreaGeometry(area), {}, {}, {}, {}};
  job.rays = cast_rays(AreaRays{.area = area}, options.rays, options.seed);
  job.samples = sample_rays(area, options.seed);
  std::copy_if(job.rays.begin(), job.rays.end(), std::back_inserter(job.served),
               [&](const Ray& ray) { return job.geometry.serves(ray); });
  job.expected.push_back(find_hits(
      job.rays, [&](const Ray& ray) { return intersect(check, mesh, ray); }, options.threads));
  return job;
}

void add_oracle(AreaJob& job, const TriangleMesh& mesh, unsigned threads, Progress& progress) {
  job.expected.push_back(find_hits(
      job.rays, [&](const Ray& ray) { return intersect_reference(mesh, ray); }, threads,
      [&](double part) { progress.advance(part); }));
}

/// Times the queries a user would make, and checks their answers.
void trace_and_check(FieldValues& values, const AreaJob& job, const Accelerator& accelerator, unsigned threads) {
  std::vector<Hit> hits;
  double least = kInf;
  for (int pass = 0; pass < kTimedPasses; ++pass) {
    const Timer timer;
    hits = find_hits(
        job.rays, [&](const Ray& ray) { return accelerator.intersect(ray); }, threads);
    least = std::min(least, timer.seconds());
  }
  values[FieldId::kTraceSeconds] = least;
  values[FieldId::kMismatches] = static_cast<double>(count_mismatches(hits, job.expected));
}

/// Costs are counted in the binary trees, which they are defined on; the time is that of the trees that users search.
FieldValues measure_tree(const Comparison& shared, const Accelerator& without_areas, const AreaJob& job,
                         const LocalTree& local, const CompareOptions& options) {
  const TreeStats tree = analyze(*local.tree, local.measure, options.costs);
  const OverlapStats overlap = analyze_overlap(*local.tree, job.geometry);
  const BuildStats build = analyze_build(*local.tree, local.log);
  const TraceStats trace = analyze_rays(*local.tree, *shared.mesh, job.served, options.costs, options.threads);
  const FallbackStats fallback =
      analyze_fallback(local, *shared.global, *shared.mesh, job.rays, options.costs, options.threads);
  FieldValues values = collect_fields(tree, &overlap, &build, &trace, &fallback);
  trace_and_check(values, job, without_areas.with_local_trees({local}), options.threads);
  return values;
}

/// Trees are built one after another: built side by side they would slow each other and report it as their own time.
ComparisonRow make_row(const Comparison& shared, const Accelerator& without_areas, const AreaJob& job,
                       const Recipe& recipe, const CompareOptions& options) {
  const std::span<const Ray> some =
      std::span(job.samples).first(std::min(job.samples.size(), sample_count(recipe, options.registry)));
  const std::vector<Ray> samples =
      samples_for(recipe, options.registry, some, *shared.mesh, shared.global.get(), options.threads);
  auto local = std::make_shared<const LocalTree>(build_local_tree(
      *shared.mesh, job.area, recipe, options.registry, options.membership, samples, {options.threads, {}, true}));
  FieldValues values = measure_tree(shared, without_areas, job, *local, options);
  return {recipe_name(recipe), job.area.name, recipe, values, std::move(local)};
}

}  // namespace

std::vector<Recipe> paper_recipes() {
  std::vector<Recipe> recipes;
  for (const char* measure : {"SAH", "PAH"}) {
    for (const char* orientation : {"LSPH", "SPFH"}) recipes.push_back({measure, orientation, "paper", {}});
  }
  for (const char* measure : {"SAH", "PAH"}) recipes.push_back({measure, "ALL", "paper", {}});
  return recipes;
}

Comparison compare(const Scene& scene, const CompareOptions& options) {
  check_options(scene, options);
  const std::vector<Recipe> recipes = options.recipes.empty() ? paper_recipes() : options.recipes;
  Progress progress(options.progress, 2 + scene.areas.size() * (recipes.size() + (options.verify ? 2 : 1)));

  Comparison result;
  result.scene = scene.name;
  result.triangles = scene.mesh.triangle_count();
  result.seed = options.seed;
  result.mesh = std::make_shared<const TriangleMesh>(scene.mesh);
  const auto tell = [&](double done) {
    progress.advance(done);
    return true;
  };
  progress.begin("build the global tree");
  result.global = std::make_shared<const Bvh>(
      build_global_tree(*result.mesh, options.global, options.registry, nullptr, {}, {options.threads, tell}));
  const Accelerator without_areas(result.mesh, {}, result.global);
  progress.begin("build the tree to check against");
  const Bvh check = build_check_tree(*result.mesh);

  for (const InfluenceArea& area : scene.areas) {
    progress.begin(area.name + ": cast rays");
    AreaJob job = make_job(*result.mesh, area, check, options);
    if (options.verify) {
      progress.begin(area.name + ": search by brute force");
      add_oracle(job, *result.mesh, options.threads, progress);
    }
    for (const Recipe& recipe : recipes) {
      progress.begin(area.name + ": " + recipe_name(recipe));
      result.rows.push_back(make_row(result, without_areas, job, recipe, options));
    }
  }
  progress.finish();
  return result;
}

size_t sample_count(const Recipe& recipe, const Registry& registry) {
  return needs_hits(recipe, registry) ? 4096 : 1000;
}

std::vector<Ray> sample_rays(const InfluenceArea& area, uint64_t seed, size_t count) {
  constexpr uint64_t kOther = 0x5a3c96e1d2b4780f;  // no seed that anyone chooses is another one's with this
  return cast_rays(AreaRays{.area = area}, count, seed ^ kOther);
}

size_t best_row(const Comparison& comparison, const std::string& area, size_t except) {
  const std::vector<ComparisonRow>& rows = comparison.rows;
  size_t best = rows.size();
  const auto costs = [&](size_t i) {
    return std::pair(rows[i].values[FieldId::kPrunedCost], rows[i].values[FieldId::kRealCost]);
  };
  for (size_t i = 0; i < rows.size(); ++i) {
    if (i != except && rows[i].area == area && (best == rows.size() || costs(i) < costs(best))) best = i;
  }
  if (best == rows.size()) throw Error(ErrorCode::kNotFound, area, "is no area of this comparison");
  return best;
}

}  // namespace raygrain

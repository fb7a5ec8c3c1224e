#include "study/tree_row.h"

#include <algorithm>
#include <cmath>

#include "raygrain/analyze.h"
#include "raygrain/heuristics.h"

#include "base/timer.h"
#include "study/ray_sums.h"

namespace raygrain::study {
namespace {

constexpr int kTimedPasses = 5;  // the least time of so many is reported

double number(size_t value) {
  return static_cast<double>(value);
}

void set_sums(Cells& cells, const RaySums& sums) {
  const double rays = number(sums.rays), served = number(sums.served), misses = number(sums.rays - sums.accepted);
  const double mean = sums.local / served, miss = sums.miss / misses;
  cells.set("real_cost_local", mean);
  cells.set("pruned_cost", sums.local_pruned / served);
  cells.set("real_cost_with_fallback", (sums.local + sums.miss) / rays);
  cells.set("pruned_cost_with_fallback", (sums.local_pruned + sums.miss_pruned) / rays);
  cells.set("global_cost", sums.global / rays);
  cells.set("global_pruned_cost", sums.global_pruned / rays);
  cells.set("local_miss_cost", miss);
  cells.set("hit_ratio", number(sums.hits) / rays);
  cells.set("local_hit_ratio", number(sums.accepted) / rays);
  cells.set("break_even_hit_ratio", break_even_hit_ratio(sums.local / rays, misses > 0 ? miss : 0, sums.global / rays));
  cells.set("rays", rays);
  cells.set("served_rays", served);
  cells.set("real_cost_deviation",
            served > 1 ? std::sqrt(std::max(0.0, (sums.local_squares - served * mean * mean) / (served - 1))) : 0);
  cells.set("mismatches", number(sums.mismatches));
}

void set_window_cells(Cells& cells, const Bvh& tree, const AreaGeometry& geometry, const CostModel& costs) {
  cells.set("estimated_pah",
            analyze(tree, projected_area_measure(geometry.area(), Culling::kWindow), costs).estimated_cost);
  cells.set("estimated_sah", analyze(tree, surface_area_measure(), costs).estimated_cost);
  const OverlapStats overlap = analyze_overlap(tree, geometry);
  for (size_t i = 0; i < kOverlapLevels.size(); ++i) {
    const std::string name = "overlap" + std::to_string(kOverlapLevels[i]);
    cells.set(name, overlap.plain[i]);
    cells.set(name + "_culled", overlap.culled[i]);
  }
}

}  // namespace

void set_ray_cells(Cells& cells, const TreeTest& test) {
  set_sums(cells, sum_rays(test));
}

void set_own_cells(Cells& cells, const Bvh& tree, const RayMeasure& own, const CostModel& costs) {
  const TreeStats stats = analyze(tree, own, costs);
  cells.set("estimated_own", stats.estimated_cost);
  cells.set("max_level", stats.max_level);
  cells.set("mean_leaf_depth", stats.mean_leaf_depth);
  cells.set("triangles", number(stats.triangles));
  cells.set("nodes", number(stats.nodes));
  cells.set("leaves", number(stats.leaves));
  cells.set("triangles_per_leaf", stats.triangles_per_leaf);
  cells.set("small_child_ratio", stats.small_child_ratio);
  cells.set("large_child_ratio", stats.large_child_ratio);
  cells.set("memory_bytes", number(stats.memory_bytes));
}

void set_build_cells(Cells& cells, const LocalTree& local) {
  const BuildStats stats = analyze_build(*local.tree, local.log);
  cells.set("orientations_per_node", stats.orientations_per_node);
  cells.set("fallback_share", stats.fallback_share);
  cells.set("build_seconds", stats.times.total);
  cells.set("orientation_seconds", stats.times.orientations);
  cells.set("candidate_seconds", stats.times.candidates);
}

double search_seconds(std::span<const Ray> rays, const std::function<void(std::span<const Ray>)>& search_all) {
  if (rays.empty()) return std::nan("");
  double least = kInf;
  for (int pass = 0; pass < kTimedPasses; ++pass) {
    const Timer timer;
    search_all(rays);
    least = std::min(least, timer.seconds());
  }
  return least / number(rays.size());
}

std::vector<Ray> served_rays(const TreeTest& test) {
  std::vector<Ray> served;
  std::copy_if(test.rays.begin(), test.rays.end(), std::back_inserter(served), test.serves);
  return served;
}

void set_tree_cells(Cells& cells, const TreeTest& test, const RayMeasure& own) {
  set_window_cells(cells, *test.local.tree, test.geometry, test.costs);
  set_own_cells(cells, *test.local.tree, own, test.costs);
  set_build_cells(cells, test.local);
  set_ray_cells(cells, test);
  const std::vector<Ray> served = served_rays(test);
  std::vector<Hit> hits(served.size());
  const WideBvh wide(*test.local.tree, test.scene.mesh, {.measure = own, .threads = 1});
  cells.set("ray_seconds", search_seconds(served, [&](std::span<const Ray> rays) { wide.intersect(rays, hits); }));
  cells.set("single_ray_seconds", search_seconds(served, [&](std::span<const Ray> rays) {
              for (size_t i = 0; i < rays.size(); ++i) hits[i] = wide.intersect(rays[i]);
            }));
  cells.set("global_ray_seconds",
            search_seconds(served, [&](std::span<const Ray> rays) { test.scene.wide_global.intersect(rays, hits); }));
}

void set_recipe_cells(Cells& cells, const Recipe& recipe, const BuildOptions& options) {
  cells.set("measure", recipe.measure);
  cells.set("orientation", recipe.orientation);
  cells.set("builder", recipe.builder);
  cells.set("split_plane_quality_threshold", static_cast<double>(options.parameters.split_plane_quality_threshold));
  cells.set("acceptable_ratio", static_cast<double>(options.parameters.acceptable_ratio));
  cells.set("excellent_ratio", static_cast<double>(options.parameters.excellent_ratio));
  cells.set("bins", options.parameters.bins);
  cells.set("max_non_fallback_levels", options.parameters.max_non_fallback_levels);
}

}  // namespace raygrain::study

namespace raygrain {

namespace {

/// In the order of a row's cells. The same whoever runs a study, and when.
constexpr const char* kGridColumns[] = {"real_cost_local",
                                        "real_cost_with_fallback",
                                        "estimated_pah",
                                        "estimated_sah",
                                        "hit_ratio",
                                        "max_level",
                                        "overlap4",
                                        "overlap7",
                                        "overlap10",
                                        "overlap15",
                                        "overlap100",
                                        "overlap4_culled",
                                        "overlap7_culled",
                                        "overlap10_culled",
                                        "overlap15_culled",
                                        "overlap100_culled",
                                        "pruned_cost",
                                        "mean_leaf_depth",
                                        "orientations_per_node",
                                        "fallback_share",
                                        "pruned_cost_with_fallback",
                                        "global_cost",
                                        "global_pruned_cost",
                                        "local_miss_cost",
                                        "local_hit_ratio",
                                        "break_even_hit_ratio",
                                        "estimated_own",
                                        "rays",
                                        "served_rays",
                                        "real_cost_deviation",
                                        "mismatches",
                                        "triangles",
                                        "nodes",
                                        "leaves",
                                        "triangles_per_leaf",
                                        "small_child_ratio",
                                        "large_child_ratio",
                                        "memory_bytes",
                                        "measure",
                                        "orientation",
                                        "builder",
                                        "split_plane_quality_threshold",
                                        "acceptable_ratio",
                                        "excellent_ratio",
                                        "bins",
                                        "max_non_fallback_levels",
                                        "frame"};
constexpr const char* kTimedGridColumns[] = {"build_seconds", "orientation_seconds", "candidate_seconds",
                                             "ray_seconds",   "single_ray_seconds",  "global_ray_seconds"};

}  // namespace

std::vector<StudyColumn> grid_columns() {
  std::vector<StudyColumn> columns;
  for (const char* name : kGridColumns) columns.push_back({name});
  for (const char* name : kTimedGridColumns) columns.push_back({name, false});
  return columns;
}

}  // namespace raygrain

// The main job: trees of several recipes for the same areas and rays, checked against each other, side by side.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "raygrain/accelerator.h"
#include "raygrain/analyze.h"
#include "raygrain/fields.h"
#include "raygrain/scene.h"

namespace raygrain {

struct CompareOptions {
  std::vector<Recipe> recipes;                // empty: the six of the paper preset (see paper_recipes)
  Recipe global{"SAH", "LSPH", "paper", {}};  // of the tree behind every local one, as in the paper
  size_t rays = 1000;                         // per area
  uint64_t seed = 1;
  bool verify = false;   // also check every hit against brute force
  unsigned threads = 0;  // 0 = all
  Registry registry = default_registry();
  CostModel costs;
  MembershipRule membership;  // for experiments; empty: overlap with the region
  /// Told what is being done and how much of the whole is done, in [0, 1]; returning false cancels (Error kCancelled).
  /// Called from one thread at a time.
  std::function<bool(const std::string& step, double done)> progress;
};

/// One tree for one area.
struct ComparisonRow {
  std::string name, area;  // recipe and area names
  Recipe recipe;
  FieldValues values;
  std::shared_ptr<const LocalTree> local;  // for pictures
};

struct Comparison {
  std::string scene;
  size_t triangles = 0;
  uint64_t seed = 1;
  std::vector<ComparisonRow> rows;  // area by area, recipes in order
  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const Bvh> global;
};

/// SAH+LSPH, SAH+SPFH, PAH+LSPH, PAH+SPFH, SAH+ALL, PAH+ALL with the preset `paper`.
std::vector<Recipe> paper_recipes();

/// Builds every recipe's local tree for every area, traces the area's rays (uniform on its window) through each, and
/// counts mismatches: rays whose hit differs in any bit from an independent global tree's (and from the oracle's with
/// `verify`). Throws Error (kUsage) for a scene without areas.
Comparison compare(const Scene& scene, const CompareOptions& options);

/// The rays of an area that recipes with samples (SAMPLED, VISIBLE) are given: others than cast_rays gives for this
/// seed, so that no tree is measured with the rays that it was built for. samples_for ends them where that is needed.
std::vector<Ray> sample_rays(const InfluenceArea& area, uint64_t seed, size_t count = 4096);
/// As many as the recipe is given in commands and studies: 4096 where its measure looks them up (VISIBLE), 1000 where
/// it asks each of them about each box (SAMPLED).
size_t sample_count(const Recipe& recipe, const Registry& registry);

/// Index into `rows` of the best recipe of an area by pruned cost, then real cost, then order; the row `except` does
/// not compete. Throws Error (kNotFound) where there is none.
size_t best_row(const Comparison& comparison, const std::string& area, size_t except = SIZE_MAX);

}  // namespace raygrain

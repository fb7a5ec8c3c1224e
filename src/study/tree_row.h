// What one tree for one area is worth: the columns that all grids of trees share.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "raygrain/accelerator.h"
#include "raygrain/study.h"
#include "raygrain/wide.h"

#include "study/cells.h"

namespace raygrain::study {

/// What all trees of a scene share.
struct SceneTrees {
  TriangleMesh mesh;
  Bvh global;
  WideBvh wide_global;
};

/// One ray in one tree.
struct RaySearch {
  Hit hit;
  double full = 0, pruned = 0;  // costs without and with pruning by the nearest hit so far
};

/// One tree with its rays. The two rules are those of the exactness contract, unless a study of others replaces them.
struct TreeTest {
  const SceneTrees& scene;
  const LocalTree& local;
  const AreaGeometry& geometry;
  std::span<const Ray> rays;
  CostModel costs;
  std::function<RaySearch(const Ray&)> search;              // in the local tree
  std::function<bool(const Ray&)> serves;                   // does it search the local tree?
  std::function<bool(const Ray&, const Hit& hit)> accepts;  // is its hit there the nearest of all?
};

/// Sets every column of grid_columns() but those of the recipe.
void set_tree_cells(Cells& cells, const TreeTest& test, const RayMeasure& own);

// The parts of it: what rays pay, the tree's shape and its worth by its own measure, what the builder noted, and the
// time of a search (NaN without rays).
void set_ray_cells(Cells& cells, const TreeTest& test);
void set_own_cells(Cells& cells, const Bvh& tree, const RayMeasure& own, const CostModel& costs);
void set_build_cells(Cells& cells, const LocalTree& local);
double search_seconds(std::span<const Ray> rays, const std::function<void(std::span<const Ray>)>& search_all);
std::vector<Ray> served_rays(const TreeTest& test);

/// Sets the columns that say how the tree was asked for.
void set_recipe_cells(Cells& cells, const Recipe& recipe, const BuildOptions& options);

/// The exactness contract's rules.
TreeTest exact_test(const SceneTrees& scene, const LocalTree& local, const AreaGeometry& geometry,
                    std::span<const Ray> rays, const CostModel& costs);

}  // namespace raygrain::study

// Rays through a local tree with the global one behind it, with and without pruning, summed.
#pragma once

#include "study/tree_row.h"

namespace raygrain::study {

struct RaySums {
  size_t rays = 0, served = 0, accepted = 0, hits = 0, mismatches = 0;
  double local = 0, local_pruned = 0, local_squares = 0;  // costs in the local tree, of the served rays
  double miss = 0, miss_pruned = 0;                       // in the global tree, of rays without an accepted local hit
  double global = 0, global_pruned = 0;                   // in the global tree, of all rays
};

RaySums sum_rays(const TreeTest& test);

}  // namespace raygrain::study

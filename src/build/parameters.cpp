// The decisions that Table 1 and figure 9 of the paper describe, and the ranges of all options.
#include <cmath>
#include <string>

#include "raygrain/build.h"
#include "raygrain/error.h"

namespace raygrain {

SplitVerdict decide_split(const SplitState& state, const PaperParameters& parameters) {
  if (state.has_split && state.ratio <= parameters.excellent_ratio) return SplitVerdict::kSatisfied;
  if (state.next.quality >= parameters.split_plane_quality_threshold) return SplitVerdict::kTry;
  if (state.has_split && state.ratio <= parameters.acceptable_ratio) return SplitVerdict::kSatisfied;
  return SplitVerdict::kFallBack;
}

bool stop_by_parameters(const StopState& state, const PaperParameters& parameters) {
  return state.cost < parameters.max_leaf_cost || state.measure < parameters.max_leaf_area ||
         state.probability < parameters.max_leaf_hit_probability ||
         state.node.count < parameters.max_triangles_per_leaf || state.node.level >= parameters.max_levels;
}

namespace {

void require(bool condition, const char* field, const char* range) {
  if (!condition) throw Error(ErrorCode::kUsage, field, "value out of range", std::string("must be ") + range);
}

/// Infinity is allowed: it makes a leaf rule or a ratio hold always.
bool not_negative(float value) {
  return value >= 0;
}

}  // namespace

void validate(const BuildOptions& options) {
  const PaperParameters& p = options.parameters;
  require(not_negative(p.max_leaf_cost), "max_leaf_cost", "0 or more");
  require(not_negative(p.max_leaf_area), "max_leaf_area", "0 or more");
  require(not_negative(p.max_leaf_hit_probability), "max_leaf_hit_probability", "0 or more");
  require(p.max_levels <= kMaxTreeLevels, "max_levels", "at most 256");
  require(p.bins >= 2 && p.bins <= 4096, "bins", "in 2 ... 4096");
  require(p.split_plane_quality_threshold >= 0 && p.split_plane_quality_threshold <= 1, "split_plane_quality_threshold",
          "in [0, 1]");
  require(not_negative(p.acceptable_ratio), "acceptable_ratio", "0 or more");
  require(not_negative(p.excellent_ratio), "excellent_ratio", "0 or more");
  require(not_negative(options.costs.inner) && std::isfinite(options.costs.inner), "costs.inner", "finite, 0 or more");
  require(not_negative(options.costs.triangle) && std::isfinite(options.costs.triangle), "costs.triangle",
          "finite, 0 or more");
  require(options.leaf_size >= 1, "leaf_size", "1 or more");
  require(options.rare_share >= 0 && std::isfinite(options.rare_share), "rare_share", "0 or more");
  require(options.spatial.overlap >= 0 && options.spatial.overlap <= 1, "spatial.overlap", "in [0, 1]");
  require(options.spatial.budget >= 0 && options.spatial.budget <= 16, "spatial.budget", "in [0, 16]");
}

}  // namespace raygrain

#include "raygrain/build.h"
#include "raygrain/error.h"

#include "build/reference_builder.h"

namespace raygrain {

namespace {

void refuse_replacements(const BuildStrategy& strategy) {
  const auto refuse = [](bool is_replaced, const char* field) {
    if (is_replaced)
      throw Error(ErrorCode::kUsage, field, "build_spatial cannot replace it", "leave it empty, or use build_binned");
  };
  refuse(static_cast<bool>(strategy.cost), "strategy.cost");
  refuse(static_cast<bool>(strategy.planes), "strategy.planes");
  refuse(static_cast<bool>(strategy.partition), "strategy.partition");
  refuse(static_cast<bool>(strategy.stop), "strategy.stop");
}

}  // namespace

Bvh build_spatial(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                  BuildLog* log) {
  validate(options);
  refuse_replacements(options.strategy);
  if (!options.clip)
    throw Error(ErrorCode::kUsage, "clip", "build_spatial cannot cut primitives without a clip callback",
                "set BuildOptions::clip, e.g. to clip_triangle_bounds of the mesh");
  const builder::Input input = builder::checked_input(bounds, centroids, options.threads);
  // Distances beyond float's range: no planes to cut at.
  if (!builder::has_references(input, options.strategy)) return build_binned(bounds, centroids, options, log);
  return builder::build_from_references(input, options, true, log);
}

}  // namespace raygrain

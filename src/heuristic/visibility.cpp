// Where rays are still alive.
#include <algorithm>
#include <memory>

#include "raygrain/heuristics.h"

#include "heuristic/entry_grid.h"

namespace raygrain {

namespace {

constexpr double kDoubt = 4;  // rays' worth of doubt: a box that no sample enters counts in full
/// The least share: where boxes of any size count as nothing, splits peel off small parts and trees become deep.
constexpr double kLeastShare = 1.0 / 16;

double alive_share(const EntryGrid& grid, const Bounds& box) {
  const EntryGrid::Counts entering = grid.entering(box);
  return std::max((entering.alive + kDoubt) / (entering.all + kDoubt), kLeastShare);
}

}  // namespace

RayMeasure visible_measure(const RayMeasure& base, std::span<const Ray> rays) {
  const auto grid = std::make_shared<const EntryGrid>(rays);
  if (!grid->has_ends()) return base;
  const auto measure = [base, grid](std::span<const Bounds> boxes, std::span<float> out) {
    base(boxes, out);
    for (size_t i = 0; i < boxes.size(); ++i)
      out[i] = static_cast<float>(static_cast<double>(out[i]) * alive_share(*grid, boxes[i]));
  };
  return RayMeasure::from_batch(measure, base.given_total());
}

}  // namespace raygrain

#include "heuristic/entry_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raygrain/vec.h"

namespace raygrain {

namespace {

constexpr size_t kCells = 48;  // along each axis
constexpr size_t kCorners = kCells + 1;
constexpr size_t kTable = kCorners * kCorners * kCorners;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// x varies fastest.
size_t index_of(size_t x, size_t y, size_t z) {
  return (z * kCorners + y) * kCorners + x;
}

/// Each entry becomes the sum of those before it along an axis whose neighbours are `step` apart.
void sum_along(std::vector<EntryGrid::Counts>& table, size_t step) {
  for (size_t i = 0; i < table.size(); ++i)
    if (i / step % kCorners != 0) table[i] += table[i - step];
}

Vec3d place_at(const Ray& ray, double t) {
  return to_double(ray.origin) + to_double(ray.direction) * t;
}

double start_of(const Ray& ray) {
  return std::max(0.0, static_cast<double>(ray.tmin));
}

}  // namespace

EntryGrid::EntryGrid(std::span<const Ray> rays) {
  for (const Ray& ray : rays) {
    if (!is_valid(ray)) continue;
    box_.extend(to_float(place_at(ray, start_of(ray))));
    if (!(ray.tmax < kInf)) continue;
    has_ends_ = true;
    box_.extend(to_float(place_at(ray, static_cast<double>(ray.tmax))));
  }
  if (!has_ends_) return;
  add_rim();
  starts_.resize(kTable);
  for (auto& senses : crossed_)
    for (auto& table : senses) table.resize(kTable);
  for (const Ray& ray : rays)
    if (is_valid(ray)) follow(ray);
  sum_up();
}

/// A little more than a cell, so that no plane of cells goes through the outermost ends. Rays that end in the outermost
/// plane of all, as those of a plane area on a flat roof do, must have ended for boxes behind it: along a flat axis the
/// rim is a thousandth of the longest one.
void EntryGrid::add_rim() {
  constexpr double kInner = kCells - 3, kThin = 1e-3;
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis)
    longest = std::max(longest, static_cast<double>(box_.hi[axis]) - static_cast<double>(box_.lo[axis]));
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = box_.lo[axis], hi = box_.hi[axis], rim = std::max((hi - lo) / kInner, kThin * longest);
    box_.lo[axis] = static_cast<float>(lo - rim);
    box_.hi[axis] = static_cast<float>(hi + rim);
  }
}

/// Everything is one cell along an axis where the grid is a point or has no end.
size_t EntryGrid::cell_of(double x, int axis) const {
  const double lo = box_.lo[axis], size = static_cast<double>(box_.hi[axis]) - lo;
  if (!(size > 0 && size < kNever)) return 0;
  const double place = (x - lo) / size * static_cast<double>(kCells);
  return place > 0 ? static_cast<size_t>(std::min(place, static_cast<double>(kCells - 1))) : 0;
}

/// From cell to cell until the grid ends, after Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing"
/// (1987).
void EntryGrid::follow(const Ray& ray) {
  const Vec3d start = place_at(ray, start_of(ray));
  Place cell{};
  std::array<double, 3> next{}, step{};  // t of the next plane, and from one plane to the next
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<size_t>(axis);
    cell[k] = cell_of(start[axis], axis);
    const double d = ray.direction[axis], lo = box_.lo[axis], size = static_cast<double>(box_.hi[axis]) - lo;
    const bool crosses = d != 0 && size > 0 && size < kNever;
    const double width = size / static_cast<double>(kCells);
    const double plane = lo + width * static_cast<double>(cell[k] + (d > 0 ? 1 : 0));
    next[k] = crosses ? (plane - static_cast<double>(ray.origin[axis])) / d : kNever;
    step[k] = crosses ? width / std::abs(d) : kNever;
  }
  const auto counts_at = [&](double t) { return Counts{1, t <= static_cast<double>(ray.tmax) ? 1u : 0u}; };
  starts_[index_of(cell[0] + 1, cell[1] + 1, cell[2] + 1)] += counts_at(start_of(ray));
  while (true) {
    const auto k = static_cast<size_t>(std::min_element(next.begin(), next.end()) - next.begin());
    const bool ascending = ray.direction[static_cast<int>(k)] > 0;
    if (!(next[k] < kNever) || cell[k] == (ascending ? kCells - 1 : 0)) return;
    const size_t plane = cell[k] + (ascending ? 1 : 0);
    crossed_[k][ascending][index_of(cell[(k + 1) % 3] + 1, cell[(k + 2) % 3] + 1, plane)] += counts_at(next[k]);
    cell[k] = ascending ? plane : plane - 1;
    next[k] += step[k];
  }
}

void EntryGrid::sum_up() {
  constexpr size_t kRow = kCorners, kPlane = kCorners * kCorners;
  for (auto& senses : crossed_)
    for (auto& table : senses) sum_along(table, 1), sum_along(table, kRow);
  for (const size_t step : {size_t{1}, kRow, kPlane}) sum_along(starts_, step);
}

EntryGrid::Counts EntryGrid::starting(const Place& lo, const Place& hi) const {
  Counts result;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto side = [&](size_t axis) { return (corner >> axis & 1) != 0 ? lo[axis] : hi[axis]; };
    const Counts& below = starts_[index_of(side(0), side(1), side(2))];
    if (((corner ^ corner >> 1 ^ corner >> 2) & 1) != 0)
      result -= below;
    else
      result += below;
  }
  return result;
}

EntryGrid::Counts EntryGrid::crossing(int axis, bool ascending, size_t plane, const Place& lo, const Place& hi) const {
  const auto k = static_cast<size_t>(axis), u = (k + 1) % 3, v = (k + 2) % 3;
  const std::vector<Counts>& table = crossed_[k][ascending];
  Counts result = table[index_of(hi[u], hi[v], plane)];
  result -= table[index_of(lo[u], hi[v], plane)];
  result -= table[index_of(hi[u], lo[v], plane)];
  result += table[index_of(lo[u], lo[v], plane)];
  return result;
}

EntryGrid::Counts EntryGrid::entering(const Bounds& box) const {
  if (!has_ends_) return {};
  Place lo{}, hi{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<size_t>(axis);
    lo[k] = cell_of(static_cast<double>(box.lo[axis]), axis);
    hi[k] = cell_of(static_cast<double>(box.hi[axis]), axis) + 1;
  }
  Counts result = starting(lo, hi);
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<size_t>(axis);
    result += crossing(axis, true, lo[k], lo, hi);
    result += crossing(axis, false, hi[k], lo, hi);
  }
  return result;
}

}  // namespace raygrain

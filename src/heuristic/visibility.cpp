// Where rays are still alive: a grid of shares, summed so that any box is asked in constant time.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "raygrain/heuristics.h"

namespace raygrain {

namespace {

constexpr size_t kCells = 32;            // along each axis
constexpr size_t kCorners = kCells + 1;  // of the summed table
constexpr int kSteps = 2 * kCells;       // along each ray

/// Sums over all cells below a corner, after Crow, "Summed-area tables for texture mapping" (1984).
class SummedGrid {
 public:
  SummedGrid() : sums_(kCorners * kCorners * kCorners) {}

  double& cell(size_t x, size_t y, size_t z) { return sums_[index(x + 1, y + 1, z + 1)]; }
  void sum_up() {
    for (int axis = 0; axis < 3; ++axis)
      for (size_t z = 0; z < kCorners; ++z)
        for (size_t y = 0; y < kCorners; ++y)
          for (size_t x = 0; x < kCorners; ++x) {
            const std::array<size_t, 3> at{x, y, z};
            if (at[static_cast<size_t>(axis)] == 0) continue;
            std::array<size_t, 3> before = at;
            --before[static_cast<size_t>(axis)];
            sums_[index(x, y, z)] += sums_[index(before[0], before[1], before[2])];
          }
  }
  /// Over the cells lo ... hi - 1.
  double operator()(const std::array<size_t, 3>& lo, const std::array<size_t, 3>& hi) const {
    double sum = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const auto side = [&](size_t axis) { return (corner >> axis & 1) != 0 ? lo[axis] : hi[axis]; };
      const bool is_odd = ((corner ^ corner >> 1 ^ corner >> 2) & 1) != 0;
      sum += (is_odd ? -1 : 1) * sums_[index(side(0), side(1), side(2))];
    }
    return sum;
  }

 private:
  static size_t index(size_t x, size_t y, size_t z) { return (z * kCorners + y) * kCorners + x; }
  std::vector<double> sums_;
};

/// Where rays go, and where they still live.
class Visibility {
 public:
  explicit Visibility(std::span<const Ray> rays) {
    for (const Ray& ray : rays) {
      if (!is_valid(ray)) continue;
      box_.extend(ray.origin);
      if (ray.tmax < kInf) box_.extend(point(ray, ray.tmax));
    }
    if (is_empty(box_)) return;
    for (const Ray& ray : rays)
      if (is_valid(ray)) follow(ray);
    met_.sum_up();
    alive_.sum_up();
  }

  /// Of the rays that pass through the box, the share that is still alive there, smoothed where few pass.
  double share(const Bounds& box) const {
    if (is_empty(box_)) return 1;
    std::array<size_t, 3> lo{}, hi{};
    for (size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = cell_of(box.lo[static_cast<int>(axis)], static_cast<int>(axis));
      hi[axis] = cell_of(box.hi[static_cast<int>(axis)], static_cast<int>(axis)) + 1;
    }
    return (alive_(lo, hi) + 0.25) / (met_(lo, hi) + 1);
  }

 private:
  static Vec3 point(const Ray& ray, float t) {
    return to_float(to_double(ray.origin) + to_double(ray.direction) * static_cast<double>(t));
  }
  size_t cell_of(float x, int axis) const {
    const double lo = box_.lo[axis], size = static_cast<double>(box_.hi[axis]) - lo;
    if (!(size > 0)) return 0;
    const double place = (static_cast<double>(x) - lo) / size * static_cast<double>(kCells);
    // No number where the box has no end.
    return place > 0 ? static_cast<size_t>(std::min(place, static_cast<double>(kCells - 1))) : 0;
  }
  /// The ray from its start to where it leaves the grid, its end notwithstanding.
  void follow(const Ray& ray) {
    double exit = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double d = ray.direction[axis], o = ray.origin[axis];
      if (d != 0) exit = std::min(exit, (static_cast<double>(d > 0 ? box_.hi[axis] : box_.lo[axis]) - o) / d);
    }
    const double start = std::max(0.0, static_cast<double>(ray.tmin));
    if (!(exit > start)) return;
    for (int i = 0; i < kSteps; ++i) {
      const double t = start + (exit - start) * (i + 0.5) / kSteps;
      const Vec3 p = to_float(to_double(ray.origin) + to_double(ray.direction) * t);
      const size_t x = cell_of(p.x, 0), y = cell_of(p.y, 1), z = cell_of(p.z, 2);
      met_.cell(x, y, z) += 1;
      if (t <= static_cast<double>(ray.tmax)) alive_.cell(x, y, z) += 1;
    }
  }

  Bounds box_;
  SummedGrid met_, alive_;
};

}  // namespace

RayMeasure visible_measure(const RayMeasure& base, std::span<const Ray> rays) {
  const auto visibility = std::make_shared<const Visibility>(rays);
  return RayMeasure::from_batch([base, visibility](std::span<const Bounds> boxes, std::span<float> out) {
    base(boxes, out);
    for (size_t i = 0; i < boxes.size(); ++i)
      out[i] = static_cast<float>(static_cast<double>(out[i]) * visibility->share(boxes[i]));
  });
}

}  // namespace raygrain

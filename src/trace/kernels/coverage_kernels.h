// Questions to a coverage grid, once per instruction set.
#pragma once

#include <optional>
#include <vector>

#include "raygrain/coverage.h"

#include "trace/coverage_grid.h"

namespace raygrain {

/// Rays that share a direction, an end or a start.
struct ColumnRays {
  enum class Kind : uint8_t {
    kAlong,    // from points[i], direction `common`, tmax infinite
    kTowards,  // from points[i], direction float32(common - points[i]), tmax 1
    kFrom,     // from `common`, direction points[i], tmax infinite
  };
  Kind kind = Kind::kAlong;
  Vec3 common;
  const Vec3* points = nullptr;

  Ray operator[](size_t i) const {
    if (kind == Kind::kAlong) return {points[i], common, 0, kInf};
    if (kind == Kind::kTowards) return {points[i], common - points[i], 0, 1};
    return {common, points[i], 0, kInf};
  }
};

/// Which of them.
struct ColumnBatch {
  ColumnRays rays;
  const uint32_t* subset = nullptr;  // null: first, first + 1, ...
  uint32_t first = 0, count = 0;
  CoverageOrder order = CoverageOrder::kAsGiven;  // kChosen: find out
  bool by_cell = false, by_tile = false;          // ... where so many rays make that worth while

  ColumnBatch part(size_t begin, size_t end) const {
    ColumnBatch some = *this;
    if (subset != nullptr) some.subset += begin;
    some.first += static_cast<uint32_t>(begin);
    some.count = static_cast<uint32_t>(end - begin);
    return some;
  }
  uint32_t number(size_t i) const { return subset != nullptr ? subset[i] : first + static_cast<uint32_t>(i); }
};

/// One ray as a column: from depth s on, up to depth `end` or from it down.
struct SingleColumn {
  float x, y, s, end;
};

/// Several grids about one eye.
struct EyeGrids {
  const CoverageGrid* const* grids = nullptr;
  uint32_t count = 0;
};

inline constexpr uint8_t kNoGrid = 255;

struct CoverageKernels {
  /// The first grid whose window holds each point (or direction), or kNoGrid.
  void (*choose)(const EyeGrids& eye, bool are_directions, const Vec3* points, size_t count, uint8_t* chosen);
  std::optional<bool> (*any_of_one)(const CoverageGrid& grid, const SingleColumn& column, const Ray& ray);
  std::optional<Hit> (*nearest_of_one)(const CoverageGrid& grid, const SingleColumn& column, const Ray& ray);
  void (*any)(const CoverageGrid& grid, const ColumnBatch& batch, uint8_t* flags, std::vector<uint32_t>& rest,
              CoverageCounters& counters);
  void (*nearest)(const CoverageGrid& grid, const ColumnBatch& batch, Hit* hits, std::vector<uint32_t>& rest,
                  CoverageCounters& counters);
};

/// Of an instruction set that kernels() has.
const CoverageKernels& coverage_kernels(Isa isa);

}  // namespace raygrain

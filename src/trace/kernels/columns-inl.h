// From rays to cells, and columns against triangles. docs/theory-coverage.md has the proofs. Included once per
// instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COLUMNS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COLUMNS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COLUMNS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COLUMNS_INL_H
#endif

#include <algorithm>

#include <hwy/highway.h>

#include "trace/kernels/coverage_kernels.h"
#include "trace/kernels/masks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kBlock = 128;
constexpr size_t kBlockRoom = kBlock + 16;  // for vectors that begin anywhere in it
constexpr size_t kMostCandidates = 8;       // for first hits, that wait at once
constexpr uint32_t kOutside = 0xffffffffu;  // not for this grid to answer
constexpr uint32_t kBeside = 0xfffffffeu;   // where nothing is

/// Columns of a block of rays. What vectors read beyond the last is zero: garbage may be denormal, and slow.
struct Block {
  alignas(64) float x[kBlockRoom], y[kBlockRoom], s[kBlockRoom];
  alignas(64) float in_tile_x[kBlock], in_tile_y[kBlock];  // place in the tile, in [0, 1) up to rounding
  alignas(64) uint32_t tile[kBlock];                       // or one of the above
  uint32_t number[kBlockRoom];                             // of the ray
  Vec3 points[kBlockRoom];

  Block() {  // NOLINT: the others are written before they are read
    for (size_t i = kBlock; i < kBlockRoom; ++i) x[i] = y[i] = s[i] = 0, number[i] = 0, points[i] = {};
  }
};

using ColumnTag = hn::CappedTag<float, 8>;
using ColumnFloats = hn::Vec<ColumnTag>;

HWY_INLINE ColumnFloats turn(const CoverageGrid& grid, size_t row, ColumnFloats x, ColumnFloats y, ColumnFloats z) {
  const ColumnTag d;
  const Vec3 r = grid.map.float_rows[row];
  return hn::MulAdd(hn::Set(d, r.x), x, hn::MulAdd(hn::Set(d, r.y), y, hn::Mul(hn::Set(d, r.z), z)));
}

/// Loads `count` rays of the batch from number `begin` on.
HWY_INLINE void load(const ColumnBatch& batch, size_t begin, size_t count, Block& block) {
  if (batch.subset == nullptr) {
    const Vec3* points = batch.rays.points + batch.first + begin;
    std::copy(points, points + count, block.points);
    for (size_t i = 0; i < count; ++i) block.number[i] = batch.number(begin + i);
    return;
  }
  for (size_t i = 0; i < count; ++i) {
    block.number[i] = batch.subset[begin + i];
    block.points[i] = batch.rays.points[block.number[i]];
  }
}

/// Points, or directions from an eye, relative to where their map begins.
struct MapPoints {
  ColumnFloats x, y, z;

  HWY_INLINE MapPoints(Vec3 center, ColumnFloats px, ColumnFloats py, ColumnFloats pz)
      : x(hn::Sub(px, hn::Set(ColumnTag(), center.x))),
        y(hn::Sub(py, hn::Set(ColumnTag(), center.y))),
        z(hn::Sub(pz, hn::Set(ColumnTag(), center.z))) {}
};

/// As many columns as a vector holds.
struct ColumnVectors {
  ColumnFloats x, y, s;
  hn::Mask<ColumnTag> is_before;  // an eye: has a depth to speak of

  HWY_INLINE ColumnVectors(const CoverageGrid& grid, const MapPoints& p)
      : x(turn(grid, 0, p.x, p.y, p.z)), y(turn(grid, 1, p.x, p.y, p.z)), s(turn(grid, 2, p.x, p.y, p.z)) {
    const ColumnTag d;
    is_before = hn::And(hn::Ge(s, hn::Set(d, 0x1p-60f)), hn::Le(s, hn::Set(d, 0x1p60f)));
    if (!grid.map.is_eye) return;
    s = hn::Div(hn::Set(d, 1.0f), s);
    x = hn::Mul(x, s);
    y = hn::Mul(y, s);
  }
};

HWY_INLINE Vec3 center_of(const CoverageGrid& grid, ColumnRays::Kind kind) {
  return kind == ColumnRays::Kind::kFrom ? Vec3{} : grid.map.center;
}

/// Finds the tiles of the block's first `count` rays.
HWY_INLINE void place(const CoverageGrid& grid, ColumnRays::Kind kind, size_t count, Block& block) {
  const ColumnTag d;
  const hn::RebindToSigned<ColumnTag> di;
  const bool are_directions = kind == ColumnRays::Kind::kFrom;
  const Vec3 center = center_of(grid, kind);
  const ColumnFloats x_lo = hn::Set(d, grid.x_lo), y_lo = hn::Set(d, grid.y_lo),
                     scale = hn::Set(d, grid.tiles_per_unit);
  const auto last_x = hn::Set(di, static_cast<int32_t>(grid.tiles_x) - 1);
  const auto last_y = hn::Set(di, static_cast<int32_t>(grid.tiles_y) - 1);
  const auto zero = hn::Zero(di);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    ColumnFloats px, py, pz;
    hn::LoadInterleaved3(d, &block.points[i].x, px, py, pz);
    const ColumnVectors columns(grid, MapPoints(center, px, py, pz));
    const ColumnFloats x = columns.x, y = columns.y, s = columns.s;
    auto inside = columns.is_before;
    if (!are_directions) inside = hn::And(hn::Ge(s, hn::Set(d, grid.s_lo)), hn::Le(s, hn::Set(d, grid.s_hi)));
    const ColumnFloats huge = hn::Set(d, 0x1p60f);
    const auto beside = hn::And(hn::And(inside, hn::Le(hn::Abs(x), huge)), hn::Le(hn::Abs(y), huge));
    inside = hn::And(inside, hn::And(hn::Ge(x, x_lo), hn::Le(x, hn::Set(d, grid.x_hi))));
    inside = hn::And(inside, hn::And(hn::Ge(y, y_lo), hn::Le(y, hn::Set(d, grid.y_hi))));
    const ColumnFloats gx = hn::IfThenElseZero(inside, hn::Mul(hn::Sub(x, x_lo), scale));
    const ColumnFloats gy = hn::IfThenElseZero(inside, hn::Mul(hn::Sub(y, y_lo), scale));
    const auto tx = hn::Max(zero, hn::Min(hn::ConvertTo(di, gx), last_x));
    const auto ty = hn::Max(zero, hn::Min(hn::ConvertTo(di, gy), last_y));
    const auto tile = hn::Add(hn::Mul(ty, hn::Set(di, static_cast<int32_t>(grid.tiles_x))), tx);
    hn::Store(x, d, block.x + i);
    hn::Store(y, d, block.y + i);
    hn::Store(s, d, block.s + i);
    hn::Store(hn::Sub(gx, hn::ConvertTo(d, tx)), d, block.in_tile_x + i);
    hn::Store(hn::Sub(gy, hn::ConvertTo(d, ty)), d, block.in_tile_y + i);
    auto marked = hn::IfThenElse(hn::RebindMask(di, inside), tile, hn::Set(di, -1));
    if (grid.is_free_beside)
      marked = hn::IfThenElse(hn::RebindMask(di, hn::AndNot(inside, beside)), hn::Set(di, -2), marked);
    hn::Store(hn::BitCast(hn::RebindToUnsigned<ColumnTag>(), marked), hn::RebindToUnsigned<ColumnTag>(),
              block.tile + i);
  }
}

/// The first grid whose window holds each of up to kBlock points of a block.
HWY_INLINE void choose_grids(const EyeGrids& eye, bool are_directions, size_t count, const Block& block,
                             uint8_t* chosen) {
  const ColumnTag d;
  const Vec3 center = are_directions ? Vec3{} : eye.grids[0]->map.center;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    ColumnFloats px, py, pz;
    hn::LoadInterleaved3(d, &block.points[i].x, px, py, pz);
    px = hn::Sub(px, hn::Set(d, center.x));
    py = hn::Sub(py, hn::Set(d, center.y));
    pz = hn::Sub(pz, hn::Set(d, center.z));
    ColumnFloats best = hn::Set(d, static_cast<float>(kNoGrid));
    for (uint32_t g = eye.count; g-- > 0;) {
      const CoverageGrid& grid = *eye.grids[g];
      const ColumnFloats x = turn(grid, 0, px, py, pz), y = turn(grid, 1, px, py, pz), z = turn(grid, 2, px, py, pz);
      const auto in_x =
          hn::And(hn::Ge(x, hn::Mul(hn::Set(d, grid.x_lo), z)), hn::Le(x, hn::Mul(hn::Set(d, grid.x_hi), z)));
      const auto in_y =
          hn::And(hn::Ge(y, hn::Mul(hn::Set(d, grid.y_lo), z)), hn::Le(y, hn::Mul(hn::Set(d, grid.y_hi), z)));
      const auto inside = hn::And(hn::And(in_x, in_y), hn::Gt(z, hn::Zero(d)));
      best = hn::IfThenElse(inside, hn::Set(d, static_cast<float>(g)), best);
    }
    alignas(64) float numbers[hn::MaxLanes(ColumnTag())];
    hn::Store(best, d, numbers);
    for (size_t lane = 0; lane < std::min(hn::Lanes(d), count - i); ++lane)
      chosen[i + lane] = static_cast<uint8_t>(numbers[lane]);
  }
}

HWY_INLINE uint32_t cell_at(const CoverageTile& tile, float x, float y) {
  const auto across = static_cast<int32_t>(tile.across);
  const auto size = static_cast<float>(across);
  const int32_t cx = std::clamp(static_cast<int32_t>(x * size), 0, across - 1);
  const int32_t cy = std::clamp(static_cast<int32_t>(y * size), 0, across - 1);
  return tile.first_cell + static_cast<uint32_t>(cy) * tile.across + static_cast<uint32_t>(cx);
}

/// The code at or below a depth's place on the tile's scale.
HWY_INLINE uint16_t code_of(const CoverageTile& tile, float s) {
  const float code = (s - tile.lowest) * tile.per_depth + kFirstCode;
  return static_cast<uint16_t>(std::min(std::max(code, 0.0f), 65535.0f));
}

using FourTag = hn::CappedTag<float, 4>;
constexpr size_t kFourLanes = hn::MaxLanes(FourTag());
constexpr size_t kFourParts = 4 / kFourLanes;
alignas(16) constexpr uint32_t kDepthLane[4] = {0, 0, 0, 0xffffffffu};

/// The four lanes of a triangle.
struct Four {
  hn::Vec<FourTag> part[kFourParts];

  /// Bit i: lane i is at least, or above, the bound.
  HWY_INLINE uint32_t at_least(float bound) const {
    uint32_t result = 0;
    for (size_t i = 0; i < kFourParts; ++i)
      result |= bits_of(FourTag(), hn::Ge(part[i], hn::Set(FourTag(), bound))) << (i * kFourLanes);
    return result;
  }
  HWY_INLINE uint32_t above(float bound) const {
    uint32_t result = 0;
    for (size_t i = 0; i < kFourParts; ++i)
      result |= bits_of(FourTag(), hn::Gt(part[i], hn::Set(FourTag(), bound))) << (i * kFourLanes);
    return result;
  }
};

/// A column in registers.
struct ColumnLanes {
  hn::Vec<FourTag> x, y;

  HWY_INLINE ColumnLanes(float x_value, float y_value)
      : x(hn::Set(FourTag(), x_value)), y(hn::Set(FourTag(), y_value)) {}

  /// a x + b y + c.
  HWY_INLINE Four at(const CoverageTriangle& triangle) const {
    const FourTag d;
    Four result;
    for (size_t i = 0; i < kFourParts; ++i) {
      const size_t lane = i * kFourLanes;
      result.part[i] = hn::MulAdd(hn::Load(d, triangle.a + lane), x,
                                  hn::MulAdd(hn::Load(d, triangle.b + lane), y, hn::Load(d, triangle.c + lane)));
    }
    return result;
  }
  /// The same with ahead * s in lane 3.
  HWY_INLINE Four at(const CoverageTriangle& triangle, hn::Vec<FourTag> s) const {
    const FourTag d;
    Four result = at(triangle);
    const size_t lane = 4 - kFourLanes;
    const auto depth_lane =
        hn::MaskFromVec(hn::BitCast(d, hn::Load(hn::RebindToUnsigned<FourTag>(), kDepthLane + lane)));
    // The id beside it is a denormal number, which some processors multiply a hundred times slower than others.
    const auto ahead = hn::IfThenElseZero(depth_lane, hn::Load(d, &triangle.margin + lane));
    auto& last = result.part[kFourParts - 1];
    last = hn::Add(last, hn::Mul(ahead, s));
    return result;
  }
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

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

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kBlock = 128;
constexpr uint32_t kOutside = 0xffffffffu;  // not for this grid to answer
constexpr uint32_t kBeside = 0xfffffffeu;   // where nothing is

/// Columns of a block of rays.
struct Block {
  alignas(64) float x[kBlock], y[kBlock], s[kBlock];
  alignas(64) float in_tile_x[kBlock], in_tile_y[kBlock];  // place in the tile, in [0, 1) up to rounding
  alignas(64) uint32_t tile[kBlock];                       // or one of the above
  uint32_t number[kBlock];                                 // of the ray
  Vec3 points[kBlock + 16];
};

using FloatTag = hn::CappedTag<float, 16>;
using Floats = hn::Vec<FloatTag>;

HWY_INLINE Floats turn(const CoverageGrid& grid, size_t row, Floats x, Floats y, Floats z) {
  const FloatTag d;
  const Vec3 r = grid.map.float_rows[row];
  return hn::MulAdd(hn::Set(d, r.x), x, hn::MulAdd(hn::Set(d, r.y), y, hn::Mul(hn::Set(d, r.z), z)));
}

/// Loads `count` rays of the batch from number `begin` on and finds their tiles.
HWY_INLINE void place(const CoverageGrid& grid, const ColumnBatch& batch, size_t begin, size_t count, Block& block) {
  const FloatTag d;
  const hn::RebindToSigned<FloatTag> di;
  for (size_t i = 0; i < count; ++i) {
    block.number[i] =
        batch.subset != nullptr ? batch.subset[begin + i] : static_cast<uint32_t>(batch.first + begin + i);
    block.points[i] = batch.rays.points[block.number[i]];
  }
  const bool are_directions = batch.rays.kind == ColumnRays::Kind::kFrom;
  const Vec3 center = are_directions ? Vec3{} : grid.map.center;
  const Floats x_lo = hn::Set(d, grid.x_lo), y_lo = hn::Set(d, grid.y_lo), scale = hn::Set(d, grid.tiles_per_unit);
  const auto last_x = hn::Set(di, static_cast<int32_t>(grid.tiles_x) - 1);
  const auto last_y = hn::Set(di, static_cast<int32_t>(grid.tiles_y) - 1);
  const auto zero = hn::Zero(di);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    Floats px, py, pz;
    hn::LoadInterleaved3(d, &block.points[i].x, px, py, pz);
    px = hn::Sub(px, hn::Set(d, center.x));
    py = hn::Sub(py, hn::Set(d, center.y));
    pz = hn::Sub(pz, hn::Set(d, center.z));
    Floats x = turn(grid, 0, px, py, pz), y = turn(grid, 1, px, py, pz), s = turn(grid, 2, px, py, pz);
    auto inside = hn::And(hn::Ge(s, hn::Set(d, 0x1p-60f)), hn::Le(s, hn::Set(d, 0x1p60f)));  // of an eye
    if (grid.map.is_eye) {
      s = hn::Div(hn::Set(d, 1.0f), s);
      x = hn::Mul(x, s);
      y = hn::Mul(y, s);
    }
    if (!are_directions) inside = hn::And(hn::Ge(s, hn::Set(d, grid.s_lo)), hn::Le(s, hn::Set(d, grid.s_hi)));
    const Floats huge = hn::Set(d, 0x1p60f);
    const auto beside = hn::And(hn::And(inside, hn::Le(hn::Abs(x), huge)), hn::Le(hn::Abs(y), huge));
    inside = hn::And(inside, hn::And(hn::Ge(x, x_lo), hn::Le(x, hn::Set(d, grid.x_hi))));
    inside = hn::And(inside, hn::And(hn::Ge(y, y_lo), hn::Le(y, hn::Set(d, grid.y_hi))));
    const Floats gx = hn::IfThenElseZero(inside, hn::Mul(hn::Sub(x, x_lo), scale));
    const Floats gy = hn::IfThenElseZero(inside, hn::Mul(hn::Sub(y, y_lo), scale));
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
    hn::Store(hn::BitCast(hn::RebindToUnsigned<FloatTag>(), marked), hn::RebindToUnsigned<FloatTag>(), block.tile + i);
  }
}

HWY_INLINE uint32_t cell_at(const CoverageTile& tile, float x, float y) {
  const int32_t across = 1 << tile.levels;
  const auto size = static_cast<float>(across);
  const int32_t cx = std::clamp(static_cast<int32_t>(x * size), 0, across - 1);
  const int32_t cy = std::clamp(static_cast<int32_t>(y * size), 0, across - 1);
  return tile.first_cell + (static_cast<uint32_t>(cy) << tile.levels) + static_cast<uint32_t>(cx);
}

/// The code at or below a depth's place on the tile's scale.
HWY_INLINE uint16_t code_of(const CoverageTile& tile, float s) {
  const float code = (s - tile.lowest) * tile.per_depth + kFirstCode;
  return static_cast<uint16_t>(std::min(std::max(code, 0.0f), 65535.0f));
}

alignas(16) constexpr uint32_t kDepthLane[4] = {0, 0, 0, 0xffffffffu};

/// A column against one triangle: bit i for each lane.
struct Verdict {
  uint32_t possible, sure;
};

using FourTag = hn::CappedTag<float, 4>;
constexpr size_t kFourLanes = hn::MaxLanes(FourTag());

HWY_INLINE Verdict meet(const CoverageTriangle& triangle, float x, float y, float s) {
  const FourTag d;
  const auto px = hn::Set(d, x), py = hn::Set(d, y), ps = hn::Set(d, s);
  const auto margin = hn::Set(d, triangle.margin);
  Verdict verdict{0, 0};
  for (size_t i = 0; i < 4; i += kFourLanes) {
    auto e = hn::MulAdd(hn::Load(d, triangle.a + i), px,
                        hn::MulAdd(hn::Load(d, triangle.b + i), py, hn::Load(d, triangle.c + i)));
    if (i + kFourLanes == 4) {
      const auto last = hn::Load(d, &triangle.margin + i);
      const auto is_depth = hn::MaskFromVec(hn::BitCast(d, hn::Load(hn::RebindToUnsigned<FourTag>(), kDepthLane + i)));
      e = hn::Add(e, hn::IfThenElseZero(is_depth, hn::Mul(last, ps)));
    }
    uint8_t possible[8] = {}, sure[8] = {};
    hn::StoreMaskBits(d, hn::Ge(e, hn::Neg(margin)), possible);
    hn::StoreMaskBits(d, hn::Gt(e, margin), sure);
    verdict.possible |= static_cast<uint32_t>(possible[0]) << i;
    verdict.sure |= static_cast<uint32_t>(sure[0]) << i;
  }
  return verdict;
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

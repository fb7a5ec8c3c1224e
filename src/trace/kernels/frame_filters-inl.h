// The filters of ray space: boxes and triangles that a column or a cone may meet. docs/theory-frames.md has the proofs.
// Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_FRAME_FILTERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_FRAME_FILTERS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_FRAME_FILTERS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_FRAME_FILTERS_INL_H
#endif

#include <algorithm>
#include <cmath>

#include <hwy/highway.h>

#include "trace/frame_memory.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// The sixteen lanes of a node or leaf are looked at in parts, as wide as the instruction set's vectors.
using FrameTag = hn::CappedTag<float, kFrameWidth>;
using FrameRefTag = hn::RebindToUnsigned<FrameTag>;
using FrameVec = hn::Vec<FrameTag>;
using FrameMask = hn::Mask<FrameTag>;
constexpr size_t kFrameLanes = hn::MaxLanes(FrameTag());

HWY_INLINE FrameVec all(float x) {
  return hn::Set(FrameTag(), x);
}
/// Bit i of lane i.
HWY_INLINE uint32_t bits_of(FrameMask mask) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(FrameTag(), mask, bytes);
  return bytes[0] | static_cast<uint32_t>(bytes[1]) << 8;
}

/// A column against the boxes of a node: six compares.
struct ColumnBoxes {
  FrameVec x_lo, x_hi, y_lo, y_hi;

  HWY_INLINE explicit ColumnBoxes(const FrameQuery& query)
      : x_lo(all(query.column.box.lo.x)),
        x_hi(all(query.column.box.hi.x)),
        y_lo(all(query.column.box.lo.y)),
        y_hi(all(query.column.box.hi.y)) {}

  /// Does the column between two depths meet them? `at` is the first lane.
  HWY_INLINE FrameMask operator()(const FrameNode& node, size_t at, FrameVec first, FrameVec last) const {
    const FrameTag tag;
    const auto x =
        hn::And(hn::Le(hn::Load(tag, node.lower[0] + at), x_hi), hn::Le(x_lo, hn::Load(tag, node.upper[0] + at)));
    const auto y =
        hn::And(hn::Le(hn::Load(tag, node.lower[1] + at), y_hi), hn::Le(y_lo, hn::Load(tag, node.upper[1] + at)));
    const auto z =
        hn::And(hn::Le(hn::Load(tag, node.lower[2] + at), last), hn::Le(first, hn::Load(tag, node.upper[2] + at)));
    return hn::And(hn::And(x, y), z);
  }
};

/// A cone against the boxes of a node: slabs in x and y, with z for the parameter.
struct ConeBoxes {
  FrameVec inverse_x, inverse_y, near_x, far_x, near_y, far_y;
  size_t near_side_x, near_side_y;  // in floats from the start of a node

  HWY_INLINE explicit ConeBoxes(const FrameQuery& query)
      : inverse_x(all(query.inverse_x)),
        inverse_y(all(query.inverse_y)),
        near_x(all(query.near_x)),
        far_x(all(query.far_x)),
        near_y(all(query.near_y)),
        far_y(all(query.far_y)),
        near_side_x(query.inverse_x < 0 ? 3 * kFrameWidth : 0),
        near_side_y(query.inverse_y < 0 ? 4 * kFrameWidth : kFrameWidth) {}

  HWY_INLINE FrameMask operator()(const FrameNode& node, size_t at, FrameVec first, FrameVec last) const {
    const float* sides = &node.lower[0][0] + at;
    const auto side = [&](size_t offset) { return hn::Load(FrameTag(), sides + offset); };
    const auto enter_x = hn::MulAdd(side(near_side_x), inverse_x, near_x);
    const auto enter_y = hn::MulAdd(side(near_side_y), inverse_y, near_y);
    const auto leave_x = hn::MulAdd(side(3 * kFrameWidth - near_side_x), inverse_x, far_x);
    const auto leave_y = hn::MulAdd(side(5 * kFrameWidth - near_side_y), inverse_y, far_y);
    const auto enter = hn::Max(hn::Max(enter_x, enter_y), hn::Max(side(2 * kFrameWidth), first));
    const auto leave = hn::Min(hn::Min(leave_x, leave_y), hn::Min(side(5 * kFrameWidth), last));
    return hn::Le(enter, leave);
  }
};

/// Bits of triangles that the ray may hit, bits of those that it surely hits, and at which depths.
struct FrameCandidates {
  uint32_t possible, sure;
  FrameVec first, last;
};

/// Some of a leaf's triangles, from one lane on.
struct FrameLanes {
  const FrameLeaf& leaf;
  size_t at;

  HWY_INLINE FrameVec field(size_t index) const { return hn::LoadU(FrameTag(), leaf.field(index) + at); }
  HWY_INLINE uint32_t present() const { return (1u << std::min(leaf.count - at, kFrameLanes)) - 1; }
};

/// What both triangle filters share: edges about a point with a radius, depths with a radius.
struct FrameLimits {
  FrameVec sure_lo, sure_hi, edge_error;

  HWY_INLINE FrameLimits(const FrameMemory& tree, const FrameQuery& query)
      : sure_lo(all(query.column.sure_lo)), sure_hi(all(query.column.sure_hi)), edge_error(all(tree.edge_error)) {}

  HWY_INLINE uint32_t decide(const FrameLanes& lanes, FrameVec x, FrameVec y, FrameVec radius, FrameVec z,
                             FrameVec z_radius, FrameVec lo, FrameVec hi, FrameCandidates& found) const {
    const auto edge = [&](size_t k) {
      return hn::MulAdd(lanes.field(3 * k), x, hn::MulAdd(lanes.field(3 * k + 1), y, lanes.field(3 * k + 2)));
    };
    const FrameVec least = hn::Min(hn::Min(edge(0), edge(1)), edge(2)), error = hn::Add(edge_error, radius);
    found.first = hn::Sub(z, z_radius);
    found.last = hn::Add(z, z_radius);
    const FrameMask inside = hn::Le(hn::Sub(hn::Zero(FrameTag()), error), least);
    const FrameMask in_time = hn::And(hn::Le(found.first, hi), hn::Le(lo, found.last));
    found.possible = bits_of(hn::And(inside, in_time)) & lanes.present();
    if (found.possible == 0) return 0;
    const FrameMask clear =
        hn::And(hn::Lt(error, least), hn::And(hn::Le(sure_lo, found.first), hn::Le(found.last, sure_hi)));
    found.sure = found.possible & bits_of(clear);
    return found.possible;
  }
};

/// A column against triangles.
struct ColumnTriangles {
  FrameLimits limits;
  FrameVec x, y, radius;

  HWY_INLINE ColumnTriangles(const FrameMemory& tree, const FrameQuery& query)
      : limits(tree, query), x(all(query.column.x)), y(all(query.column.y)), radius(all(query.column.radius)) {}

  /// Returns found.possible; where it is 0, `found` is not set.
  HWY_INLINE uint32_t operator()(const FrameLanes& lanes, FrameVec lo, FrameVec hi, FrameCandidates& found) const {
    const FrameVec p = lanes.field(FrameLeaf::kP), q = lanes.field(FrameLeaf::kQ);
    const FrameVec z = hn::MulAdd(p, x, hn::MulAdd(q, y, lanes.field(FrameLeaf::kR)));
    const FrameVec z_radius = hn::MulAdd(hn::Add(hn::Abs(p), hn::Abs(q)), radius, lanes.field(FrameLeaf::kError));
    return limits.decide(lanes, x, y, radius, z, z_radius, lo, hi, found);
  }
};

/// A cone against triangles: where the ray, followed from the middle of the leaf's depths, crosses each plane.
struct ConeTriangles {
  FrameLimits limits;
  float x0, y0, slope_x, slope_y, error, slope;

  HWY_INLINE ConeTriangles(const FrameMemory& tree, const FrameQuery& query)
      : limits(tree, query),
        x0(query.x0),
        y0(query.y0),
        slope_x(query.slope_x),
        slope_y(query.slope_y),
        error(query.error),
        slope(std::max(std::abs(query.slope_x), std::abs(query.slope_y)) * (1 + 0x1p-20f)) {}

  HWY_INLINE uint32_t operator()(const FrameLanes& lanes, FrameVec lo, FrameVec hi, FrameCandidates& found) const {
    const float half = lanes.leaf.half(), middle = lanes.leaf.middle();
    const FrameVec p = lanes.field(FrameLeaf::kP), q = lanes.field(FrameLeaf::kQ);
    const FrameVec x = all(x0 + slope_x * middle), y = all(y0 + slope_y * middle);
    const FrameVec plane = hn::MulAdd(p, x, hn::MulAdd(q, y, lanes.field(FrameLeaf::kR)));
    const FrameVec along = hn::MulAdd(p, all(slope_x), hn::Mul(q, all(slope_y)));
    const FrameVec stretch = hn::Div(all(1), hn::Sub(all(1), along));
    const FrameVec away = hn::Mul(hn::Sub(plane, all(middle)), stretch), z = hn::Add(all(middle), away);
    const FrameVec steep = hn::Add(hn::Abs(p), hn::Abs(q)), size = hn::Abs(stretch);
    const FrameVec own = hn::MulAdd(steep, all(error), lanes.field(FrameLeaf::kError));
    const FrameVec doubt = hn::MulAdd(hn::Mul(steep, all(slope)), size, all(2));
    const FrameVec spread = hn::Mul(own, size);
    const FrameVec rounding = hn::MulAdd(doubt, hn::Add(hn::Abs(away), spread), all(std::abs(middle)));
    const FrameVec radius = hn::MulAdd(spread, all(1 + 0x1p-18f), hn::Mul(all(0x1p-20f), rounding));
    // Comparisons with what is not a number are false, and nothing is sure then.
    const FrameVec most = all(2 * half), top = all(middle + half), bottom = all(middle - half);
    const FrameMask is_known = hn::And(hn::Le(radius, most), hn::Le(doubt, all(0x1p16f)));
    const FrameMask is_low = hn::Le(z, top), is_high = hn::Le(bottom, z);
    const FrameVec z_radius = hn::IfThenElse(is_known, radius, most);
    const FrameVec z_here = hn::IfThenElse(is_low, hn::IfThenElse(is_high, z, bottom), top);
    const FrameVec x_here = hn::MulAdd(z_here, all(slope_x), all(x0)),
                   y_here = hn::MulAdd(z_here, all(slope_y), all(y0));
    const FrameVec side = hn::MulAdd(z_radius, all(slope), all(error));
    if (limits.decide(lanes, x_here, y_here, side, z_here, z_radius, lo, hi, found) == 0) return 0;
    found.sure &= bits_of(hn::And(is_known, hn::And(is_low, is_high)));
    return found.possible;
  }
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

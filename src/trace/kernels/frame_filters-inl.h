// The filters of ray space: boxes and triangles that a column or a cone may meet. docs/theory-frames.md has the proofs.
// Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_FRAME_FILTERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_FRAME_FILTERS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_FRAME_FILTERS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_FRAME_FILTERS_INL_H
#endif

#include "trace/frame_memory.h"
#include "trace/kernels/eight-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

using BoxMask = hn::Mask<Tag>;
using RefTag = hn::RebindToUnsigned<Tag>;

/// A column against eight boxes: six compares.
struct ColumnBoxes {
  Eight x_lo, x_hi, y_lo, y_hi;

  HWY_INLINE explicit ColumnBoxes(const FrameQuery& query)
      : x_lo(broadcast(query.column.box.lo.x)),
        x_hi(broadcast(query.column.box.hi.x)),
        y_lo(broadcast(query.column.box.lo.y)),
        y_hi(broadcast(query.column.box.hi.y)) {}

  /// Does the column between two depths meet the boxes of one part of a node?
  HWY_INLINE BoxMask operator()(const FrameNode& node, size_t part, const Eight& first, const Eight& last) const {
    const Tag tag;
    const size_t at = part * kLanes;
    const auto x = hn::And(hn::Le(hn::Load(tag, node.lower[0] + at), x_hi.part[part]),
                           hn::Le(x_lo.part[part], hn::Load(tag, node.upper[0] + at)));
    const auto y = hn::And(hn::Le(hn::Load(tag, node.lower[1] + at), y_hi.part[part]),
                           hn::Le(y_lo.part[part], hn::Load(tag, node.upper[1] + at)));
    const auto z = hn::And(hn::Le(hn::Load(tag, node.lower[2] + at), last.part[part]),
                           hn::Le(first.part[part], hn::Load(tag, node.upper[2] + at)));
    return hn::And(hn::And(x, y), z);
  }
};

/// A cone against eight boxes: slabs in x and y, with z for the parameter.
struct ConeBoxes {
  Eight inverse_x, inverse_y, near_x, far_x, near_y, far_y;
  size_t near_side_x, near_side_y;  // in floats from the start of a node

  HWY_INLINE explicit ConeBoxes(const FrameQuery& query)
      : inverse_x(broadcast(query.inverse_x)),
        inverse_y(broadcast(query.inverse_y)),
        near_x(broadcast(query.near_x)),
        far_x(broadcast(query.far_x)),
        near_y(broadcast(query.near_y)),
        far_y(broadcast(query.far_y)),
        near_side_x(query.inverse_x < 0 ? 3 * kWidth : 0),
        near_side_y(query.inverse_y < 0 ? 4 * kWidth : kWidth) {}

  HWY_INLINE BoxMask operator()(const FrameNode& node, size_t part, const Eight& first, const Eight& last) const {
    const Tag tag;
    const float* sides = &node.lower[0][0] + part * kLanes;
    const auto side = [&](size_t offset) { return hn::Load(tag, sides + offset); };
    const auto enter_x = hn::MulAdd(side(near_side_x), inverse_x.part[part], near_x.part[part]);
    const auto enter_y = hn::MulAdd(side(near_side_y), inverse_y.part[part], near_y.part[part]);
    const auto leave_x = hn::MulAdd(side(3 * kWidth - near_side_x), inverse_x.part[part], far_x.part[part]);
    const auto leave_y = hn::MulAdd(side(5 * kWidth - near_side_y), inverse_y.part[part], far_y.part[part]);
    const auto enter = hn::Max(hn::Max(enter_x, enter_y), hn::Max(side(2 * kWidth), first.part[part]));
    const auto leave = hn::Min(hn::Min(leave_x, leave_y), hn::Min(side(5 * kWidth), last.part[part]));
    return hn::Le(enter, leave);
  }
};

/// Bits of triangles that the ray may hit, bits of those that it surely hits, and at which depths.
struct FrameCandidates {
  uint32_t possible, sure;
  Eight first, last;
};

/// What both triangle filters share: edges about a point with a radius, depths with a radius.
struct FrameTest {
  Eight x, y, radius, z, z_radius;
};

struct FrameLimits {
  Eight sure_lo, sure_hi, edge_error;

  HWY_INLINE FrameLimits(const FrameMemory& tree, const FrameQuery& query)
      : sure_lo(broadcast(query.column.sure_lo)),
        sure_hi(broadcast(query.column.sure_hi)),
        edge_error(broadcast(tree.edge_error)) {}

  HWY_INLINE uint32_t decide(const FrameLeaf& leaf, const FrameTest& test, float lo, float hi,
                             FrameCandidates& found) const {
    const auto edge = [&](size_t k) {
      return multiply_add(
          load_unaligned(leaf.field(3 * k)), test.x,
          multiply_add(load_unaligned(leaf.field(3 * k + 1)), test.y, load_unaligned(leaf.field(3 * k + 2))));
    };
    const Eight least = min(min(edge(0), edge(1)), edge(2)), error = edge_error + test.radius;
    const uint32_t inside = less_equal(broadcast(0.0f) - error, least) & ((1u << leaf.count) - 1);
    if (inside == 0) return 0;
    found.first = test.z - test.z_radius;
    found.last = test.z + test.z_radius;
    found.possible = inside & less_equal(found.first, broadcast(hi)) & less_equal(broadcast(lo), found.last);
    found.sure =
        found.possible & ~less_equal(least, error) & less_equal(sure_lo, found.first) & less_equal(found.last, sure_hi);
    return found.possible;
  }
};

/// A column against eight triangles.
struct ColumnTriangles {
  FrameLimits limits;
  Eight x, y, radius;

  HWY_INLINE ColumnTriangles(const FrameMemory& tree, const FrameQuery& query)
      : limits(tree, query),
        x(broadcast(query.column.x)),
        y(broadcast(query.column.y)),
        radius(broadcast(query.column.radius)) {}

  /// Returns found.possible; where it is 0, `found` is not set.
  HWY_INLINE uint32_t operator()(const FrameLeaf& leaf, float lo, float hi, FrameCandidates& found) const {
    const Eight p = load_unaligned(leaf.field(FrameLeaf::kP)), q = load_unaligned(leaf.field(FrameLeaf::kQ));
    const Eight z = multiply_add(p, x, multiply_add(q, y, load_unaligned(leaf.field(FrameLeaf::kR))));
    const Eight z_radius =
        multiply_add(absolute(p) + absolute(q), radius, load_unaligned(leaf.field(FrameLeaf::kError)));
    return limits.decide(leaf, {x, y, radius, z, z_radius}, lo, hi, found);
  }
};

/// A cone against eight triangles: from the middle of the leaf's depths to the plane's depth there, which is near where
/// the ray crosses it.
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

  HWY_INLINE uint32_t operator()(const FrameLeaf& leaf, float lo, float hi, FrameCandidates& found) const {
    const float half = 1.5f * leaf.half(), middle = leaf.middle();
    const Eight p = load_unaligned(leaf.field(FrameLeaf::kP)), q = load_unaligned(leaf.field(FrameLeaf::kQ));
    const Eight x = broadcast(x0 + slope_x * middle), y = broadcast(y0 + slope_y * middle);
    const Eight z = multiply_add(p, x, multiply_add(q, y, load_unaligned(leaf.field(FrameLeaf::kR))));
    const Eight p_size = absolute(p), q_size = absolute(q);
    const Eight lean = multiply_add(p_size, broadcast(std::abs(slope_x) * (1 + 0x1p-20f)),
                                    q_size * broadcast(std::abs(slope_y) * (1 + 0x1p-20f)));
    const Eight own = multiply_add(p_size + q_size, broadcast(error), load_unaligned(leaf.field(FrameLeaf::kError)));
    const Eight reach = multiply_add(lean, broadcast(half), own);
    const Eight z_radius = min(reach, broadcast(2 * half));
    const Eight z_here = max(min(z, broadcast(middle + half)), broadcast(middle - half));
    const FrameTest test{multiply_add(z_here, broadcast(slope_x), broadcast(x0)),
                         multiply_add(z_here, broadcast(slope_y), broadcast(y0)),
                         multiply_add(z_radius, broadcast(slope), broadcast(error)), z_here, z_radius};
    if (limits.decide(leaf, test, lo, hi, found) == 0) return 0;
    // It crosses the plane within the leaf's depths.
    const Eight away = absolute(z - broadcast(middle));
    found.sure &= less_equal(away + reach, broadcast(half));
    return found.possible;
  }
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

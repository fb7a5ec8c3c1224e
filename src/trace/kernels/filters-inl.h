// The two float filters: boxes that a ray may meet, and triangles that it may hit. Both keep too much rather than too
// little; docs/theory.md, section "Wide trees in float", has the proofs. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_FILTERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_FILTERS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_FILTERS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_FILTERS_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "trace/kernels/eight-inl.h"
#include "trace/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

constexpr float kRoundoff = 0x1p-24f;

/// Floats serve for rays and scenes of these sizes; others take the careful path.
constexpr float kLeast = 0x1p-30f, kGreatest = 0x1p30f;
/// ... and for origins at most so many scene sizes away.
constexpr float kFarthest = 0x1p10f;

/// Numbers of a ray are kept as floats where many rays are in flight, so that they fit the first cache; as vectors, in
/// registers, where a ray is alone.
template <class Kept>
HWY_INLINE Kept kept(float x) {
  if constexpr (std::is_same_v<Kept, float>)
    return x;
  else
    return broadcast(x);
}

/// A ray against eight boxes: per axis, t = side * inverse + offset.
template <class Kept>
struct BoxFilter {
  Kept inverse[3], near_offset[3], far_offset[3];
  Kept earliest;
  size_t near_side[3], far_side[3];  // in floats from the start of a node

  /// False if floats do not serve for this ray, or if its origin or direction is not finite or its direction zero.
  HWY_INLINE bool prepare(const WideTree& tree, const Ray& ray, float skip_before) {
    const float origin[3] = {relative(ray.origin.x, tree.center.x), relative(ray.origin.y, tree.center.y),
                             relative(ray.origin.z, tree.center.z)};
    const float direction[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    const float distance = std::max(std::max(std::abs(origin[0]), std::abs(origin[1])), std::abs(origin[2]));
    const float length = std::max(std::max(std::abs(direction[0]), std::abs(direction[1])), std::abs(direction[2]));
    const float size = tree.reach + distance;
    // A maximum may overlook a NaN, a sum does not.
    const float sum = ((origin[0] + origin[1]) + (direction[0] + direction[1])) + (origin[2] + direction[2]);
    const bool is_served = (size >= kLeast) & (size <= kGreatest) & (length >= kLeast) & (length <= kGreatest) &
                           (distance <= kFarthest * tree.reach) & (sum == sum);
    if (!is_served) return false;
    const float padding = 8 * kRoundoff * size, least = 0x1p-40f * length;
    for (size_t axis = 0; axis < 3; ++axis) {
      // Without branches: signs are hard to predict.
      const size_t backward = std::bit_cast<uint32_t>(direction[axis]) >> 31;
      const float reciprocal = 1 / std::max(std::abs(direction[axis]), least);
      const float inverse_of_axis = std::copysign(reciprocal, direction[axis]);
      const float offset = -origin[axis] * inverse_of_axis, slack = padding * reciprocal;
      inverse[axis] = kept<Kept>(inverse_of_axis);
      near_offset[axis] = kept<Kept>(offset - slack);
      far_offset[axis] = kept<Kept>(offset + slack);
      near_side[axis] = (axis + 3 * backward) * kWidth;
      far_side[axis] = (axis + 3 * (1 - backward)) * kWidth;
    }
    earliest = kept<Kept>(std::max(ray.tmin, skip_before));
    return true;
  }

  /// Bit i: the ray may meet child i at a t <= bound that counts, and not before entry[i].
  HWY_INLINE uint32_t operator()(const WideNode& node, float bound, float* entry) const {
    const float* sides = &node.lower[0][0];
    const Eight near_x = multiply_add(load(sides + near_side[0]), broadcast(inverse[0]), broadcast(near_offset[0]));
    const Eight near_y = multiply_add(load(sides + near_side[1]), broadcast(inverse[1]), broadcast(near_offset[1]));
    const Eight near_z = multiply_add(load(sides + near_side[2]), broadcast(inverse[2]), broadcast(near_offset[2]));
    const Eight far_x = multiply_add(load(sides + far_side[0]), broadcast(inverse[0]), broadcast(far_offset[0]));
    const Eight far_y = multiply_add(load(sides + far_side[1]), broadcast(inverse[1]), broadcast(far_offset[1]));
    const Eight far_z = multiply_add(load(sides + far_side[2]), broadcast(inverse[2]), broadcast(far_offset[2]));
    const Eight enter = max(max(near_x, near_y), max(near_z, broadcast(earliest)));
    const Eight leave = min(min(far_x, far_y), min(far_z, broadcast(bound)));
    store(enter, entry);
    return less_equal(enter, leave);
  }

 private:
  static float relative(float x, float center) { return x - center; }
};

/// A ray against eight triangles.
struct TrianglePairs {
  EightVectors origin, direction, a, b, c;
  Eight earliest, latest;  // of t
  float length, size;      // the greatest component of the direction; at least that of all edges
  uint32_t lanes;          // that count
};

constexpr float kFloor = 0x1p-56f, kTiny = 0x1p-100f;  // cover what underflows

/// What both questions about pairs begin with: on which sides of the edges the ray passes; t = numerator / sum.
struct PairSides {
  Eight sum, numerator, distance;
  Eight lowest, highest, error;  // of the weights
  uint32_t inside;               // lanes that the ray may pass within the edges
};

HWY_INLINE PairSides sides_of(const TrianglePairs& pairs) {
  const EightVectors to_a = pairs.a - pairs.origin, ab = pairs.b - pairs.a, ac = pairs.c - pairs.a;
  const EightVectors moment = cross(pairs.direction, to_a), normal = cross(ab, ac);
  const Eight sum = dot(pairs.direction, normal), minus_b = dot(moment, ac), weight_c = dot(moment, ab);
  const Eight weight_a = sum + minus_b - weight_c, weight_b = broadcast(0.0f) - minus_b;
  PairSides sides;
  sides.distance = largest_component(to_a);
  const float scale = pairs.length * pairs.size * (128 * kRoundoff);
  sides.error = multiply_add(broadcast(scale), sides.distance, broadcast(scale * pairs.size + kFloor));
  sides.lowest = min(min(weight_a, weight_b), weight_c), sides.highest = max(max(weight_a, weight_b), weight_c);
  const uint32_t not_negative = less_equal(broadcast(0.0f) - sides.error, sides.lowest);
  const uint32_t not_positive = less_equal(sides.highest, sides.error);
  sides.inside = (not_negative | not_positive) & pairs.lanes;
  sides.sum = sum, sides.numerator = dot(to_a, normal);
  return sides;
}

HWY_INLINE uint32_t strictly_inside(const PairSides& s) {
  return ~(less_equal(s.lowest, s.error) & less_equal(broadcast(0.0f) - s.error, s.highest));
}

/// Bounds of the errors of sum and numerator, and bits of lanes where the sum's is small beside it.
struct PairErrors {
  Eight sum, numerator;
  uint32_t steep;
};

HWY_INLINE PairErrors errors_of(const TrianglePairs& pairs, const PairSides& sides) {
  const float area = pairs.size * pairs.size * (64 * kRoundoff);
  const Eight sum = broadcast(area * pairs.length + kFloor);
  return {sum, multiply_add(broadcast(area), sides.distance, broadcast(kFloor)),
          less_equal(broadcast(4.0f) * sum, absolute(sides.sum))};
}

/// Bits of lanes whose ray may hit its triangle, and of those whose ray surely does if `last` is not too late; the
/// bounds of t, unknown where it is not steep.
struct PairHits {
  Eight first, last;
  uint32_t possible = 0, sure = 0, steep = 0;
};

/// kEarlyOut: where nothing is possible, no more may be set.
template <bool kEarlyOut>
HWY_INLINE PairHits meet(const TrianglePairs& pairs) {
  const PairSides sides = sides_of(pairs);
  PairHits found;  // NOLINT: its bounds are written below
  if (kEarlyOut && sides.inside == 0) return found;
  const PairErrors errors = errors_of(pairs, sides);
  const Eight inverse = broadcast(1.0f) / sides.sum;
  const Eight t = sides.numerator * inverse;
  const Eight t_size = absolute(t), twice = absolute(inverse + inverse);
  const Eight slack = multiply_add(t_size, broadcast(8 * kRoundoff), broadcast(kTiny));
  const Eight radius = multiply_add(multiply_add(t_size, errors.sum, errors.numerator), twice, slack);
  found.first = t - radius, found.last = t + radius;
  found.steep = errors.steep;
  const uint32_t early = less_equal(found.first, pairs.latest), late = less_equal(pairs.earliest, found.last);
  found.possible = sides.inside & (~found.steep | (early & late));
  // Strictly inside, and t surely not too early.
  found.sure = found.possible & found.steep & strictly_inside(sides) & less_equal(pairs.earliest, found.first);
  return found;
}

/// Bits of lanes whose ray may hit its triangle within its range of t, and of those whose ray surely does there.
struct AnyHits {
  uint32_t possible = 0, sure = 0;
};

/// Without the bounds of t, and so without a division. kEarlyOut: a jump where nothing is possible.
template <bool kEarlyOut>
HWY_INLINE AnyHits meet_any(const TrianglePairs& pairs) {
  const PairSides sides = sides_of(pairs);
  if (kEarlyOut && sides.inside == 0) return {};
  const PairErrors errors = errors_of(pairs, sides);
  const Eight magnitude = absolute(sides.sum), numerator = times_sign(sides.numerator, sides.sum);
  const Eight after = subtract_product(numerator, pairs.earliest, magnitude);  // t - earliest, times the sum
  const Eight before = multiply_add(pairs.latest, magnitude, broadcast(0.0f) - numerator);
  const Eight per_t = multiply_add(magnitude, broadcast(8 * kRoundoff), errors.sum);
  const Eight rest = multiply_add(magnitude, broadcast(kTiny), errors.numerator);
  const Eight after_error = multiply_add(absolute(pairs.earliest), per_t, rest);
  const Eight before_error = multiply_add(absolute(pairs.latest), per_t, rest);
  const uint32_t in_time =
      less_equal(broadcast(0.0f) - after_error, after) & less_equal(broadcast(0.0f) - before_error, before);
  const uint32_t surely = less_equal(after_error, after) & less_equal(before_error, before);
  return {sides.inside & (~errors.steep | in_time), sides.inside & errors.steep & surely & strictly_inside(sides)};
}

/// Bits of triangles that the ray may hit, bits of those that it surely hits, and where.
struct Candidates {
  uint32_t possible, sure;
  alignas(32) float earliest[8], latest[8];  // of t, for possible ones; earliest = -infinity where unknown
};

/// Those of the possible ones that do not surely lie behind `bound`. In leaves that are long along the rays most of
/// what is hit lies behind another hit, and to decide it is dear: where walls stand across an axis, t is half way
/// between two floats as often as not, and rounding it takes exact arithmetic.
HWY_INLINE uint32_t not_behind(const Candidates& found, float bound) {
  return found.possible & less_equal(load(found.earliest), broadcast(bound));
}

/// A ray against the triangles of leaves.
template <class Kept>
struct TriangleFilter {
  Kept origin[3], direction[3];
  Kept earliest;
  float length;

  HWY_INLINE void prepare(const Ray& ray) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = kept<Kept>(ray.origin[axis]);
      direction[axis] = kept<Kept>(ray.direction[axis]);
    }
    earliest = kept<Kept>(ray.tmin);
    length = std::max(std::max(std::abs(ray.direction.x), std::abs(ray.direction.y)), std::abs(ray.direction.z));
  }

  HWY_INLINE TrianglePairs pairs(const WideLeaf& leaf, ChildRef ref, float bound) const {
    return {broadcast(origin),    broadcast(direction),         load_corner(leaf, 0), load_corner(leaf, 1),
            load_corner(leaf, 2), broadcast(earliest),          broadcast(bound),     length,
            size_of(ref),         (1u << triangles_of(ref)) - 1};
  }

  /// Returns found.possible. kEarlyOut: where it is 0, `found` may not be set.
  template <bool kEarlyOut>
  HWY_INLINE uint32_t test(const WideLeaf& leaf, ChildRef ref, float bound, Candidates& found) const {
    const PairHits hits = meet<kEarlyOut>(pairs(leaf, ref, bound));
    if (kEarlyOut && hits.possible == 0) return 0;
    store(hits.first, found.earliest);
    store(hits.last, found.latest);
    found.possible = hits.possible, found.sure = hits.sure;
    for (uint32_t flat = hits.possible & ~hits.steep; flat != 0; flat &= flat - 1)
      found.earliest[std::countr_zero(flat)] = -std::numeric_limits<float>::infinity();
    return found.possible;
  }
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

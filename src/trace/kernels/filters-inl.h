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

/// A ray against eight boxes: per axis, t = side * inverse + offset.
struct BoxFilter {
  Eight inverse[3], near_offset[3], far_offset[3];
  Eight earliest;
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
      inverse[axis] = broadcast(inverse_of_axis);
      near_offset[axis] = broadcast(offset - slack);
      far_offset[axis] = broadcast(offset + slack);
      near_side[axis] = (axis + 3 * backward) * kWidth;
      far_side[axis] = (axis + 3 * (1 - backward)) * kWidth;
    }
    earliest = broadcast(std::max(ray.tmin, skip_before));
    return true;
  }

  /// Bit i: the ray may meet child i at a t <= bound that counts, and not before entry[i].
  HWY_INLINE uint32_t operator()(const WideNode& node, float bound, float* entry) const {
    const float* sides = &node.lower[0][0];
    const Eight near_x = multiply_add(load(sides + near_side[0]), inverse[0], near_offset[0]);
    const Eight near_y = multiply_add(load(sides + near_side[1]), inverse[1], near_offset[1]);
    const Eight near_z = multiply_add(load(sides + near_side[2]), inverse[2], near_offset[2]);
    const Eight far_x = multiply_add(load(sides + far_side[0]), inverse[0], far_offset[0]);
    const Eight far_y = multiply_add(load(sides + far_side[1]), inverse[1], far_offset[1]);
    const Eight far_z = multiply_add(load(sides + far_side[2]), inverse[2], far_offset[2]);
    const Eight enter = max(max(near_x, near_y), max(near_z, earliest));
    const Eight leave = min(min(far_x, far_y), min(far_z, broadcast(bound)));
    store(enter, entry);
    return less_equal(enter, leave);
  }

 private:
  static float relative(float x, float center) { return x - center; }
};

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

/// A ray against eight triangles.
struct TriangleFilter {
  EightVectors origin, direction;
  Eight earliest;
  float length;

  HWY_INLINE void prepare(const Ray& ray) {
    origin = broadcast(ray.origin);
    direction = broadcast(ray.direction);
    earliest = broadcast(ray.tmin);
    length = std::max(std::max(std::abs(ray.direction.x), std::abs(ray.direction.y)), std::abs(ray.direction.z));
  }

  /// Returns found.possible. kEarlyOut: where it is 0, `found` may not be set.
  template <bool kEarlyOut>
  HWY_INLINE uint32_t test(const WideLeaf& leaf, ChildRef ref, float bound, Candidates& found) const {
    constexpr float kFloor = 0x1p-56f, kTiny = 0x1p-100f;  // cover what underflows
    const float size = size_of(ref);
    const EightVectors a = load_corner(leaf, 0);
    const EightVectors to_a = a - origin, ab = load_corner(leaf, 1) - a, ac = load_corner(leaf, 2) - a;
    const EightVectors moment = cross(direction, to_a), normal = cross(ab, ac);
    const Eight sum = dot(direction, normal), minus_b = dot(moment, ac), weight_c = dot(moment, ab);
    const Eight weight_a = sum + minus_b - weight_c;
    const Eight distance = largest_component(to_a);
    const float scale = 128 * kRoundoff * length * size;
    const Eight error = multiply_add(broadcast(scale), distance, broadcast(scale * size + kFloor));
    const Eight weight_b = broadcast(0.0f) - minus_b;
    const Eight lowest = min(min(weight_a, weight_b), weight_c), highest = max(max(weight_a, weight_b), weight_c);
    const Eight below = broadcast(0.0f) - error;
    const uint32_t not_negative = less_equal(below, lowest), not_positive = less_equal(highest, error);
    const uint32_t inside = (not_negative | not_positive) & ((1u << triangles_of(ref)) - 1);
    if (kEarlyOut && inside == 0) return 0;

    const float area = 64 * kRoundoff * size * size;
    const Eight sum_error = broadcast(area * length + kFloor);
    const Eight numerator_error = multiply_add(broadcast(area), distance, broadcast(kFloor));
    const Eight inverse = broadcast(1.0f) / sum;
    const Eight t = dot(to_a, normal) * inverse;
    const Eight magnitude = absolute(sum), t_size = absolute(t), twice = absolute(inverse + inverse);
    const Eight slack = multiply_add(t_size, broadcast(8 * kRoundoff), broadcast(kTiny));
    const Eight radius = multiply_add(multiply_add(t_size, sum_error, numerator_error), twice, slack);
    const Eight first = t - radius, last = t + radius;
    const uint32_t steep = less_equal(broadcast(4.0f) * sum_error, magnitude);
    const uint32_t early = less_equal(first, broadcast(bound)), late = less_equal(earliest, last);
    store(first, found.earliest);
    store(last, found.latest);
    found.possible = inside & (~steep | (early & late));
    for (uint32_t flat = found.possible & ~steep; flat != 0; flat &= flat - 1)
      found.earliest[std::countr_zero(flat)] = -std::numeric_limits<float>::infinity();
    // Strictly inside, and t surely in range.
    const uint32_t clear = ~(less_equal(lowest, error) & less_equal(below, highest));
    found.sure = found.possible & steep & clear & less_equal(earliest, first);
    return found.possible;
  }
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

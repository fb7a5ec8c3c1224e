// The fast path: double precision with a proven bound of its error. Whatever is not certain goes to exact arithmetic,
// so the answer never depends on how this file is compiled. The bounds are derived in docs/theory.md, section "Exact
// intersection".
//
// No operation here overflows or underflows: finite floats are multiples of 2^-149 below 2^128, so a product of three
// differences of them is 0 or between 2^-447 and 2^390 in magnitude, and a quotient of two such sums is 0 or between
// 2^-840 and 2^840; doubles reach from 2^-1022 to 2^1023.
#include "raygrain/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/triangle_small.h"

namespace raygrain {
namespace {

static_assert(std::numeric_limits<float>::is_iec559 && std::numeric_limits<double>::is_iec559);

constexpr double kRoundoff = 0x1p-53;

// At most 8 roundings meet in each of the 6 terms of a determinant: 48 units, rounded up to a power of two ...
constexpr double kDeterminantError = 64 * kRoundoff;
// ... and 102 units in the weight that is the difference of three.
constexpr double kWeightError = 128 * kRoundoff;
// The same relative to the sum of the terms' magnitudes.
constexpr double kRelativeError = 10 * kRoundoff;

// Stands for a real number in [value - error, value + error].
struct Estimate {
  double value, error;

  bool is_positive() const { return value > error; }
  bool is_negative() const { return value < -error; }
  bool is_zero() const { return value == 0 && error == 0; }
  bool is_unsure() const { return !is_positive() && !is_negative() && !is_zero(); }
};

// The determinants of the definition: the weights of the three corners, their sum, and the numerator of t.
struct Estimates {
  Estimate weight_a, weight_b, weight_c, sum, numerator;
};

struct Edges {
  Vec3d direction, to_a, ab, ac;
};

enum class Verdict { kMiss, kHit, kUnsure };

Vec3d absolute(Vec3d a) {
  return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}

double largest_component(Vec3d a) {
  const Vec3d b = absolute(a);
  return std::max(std::max(b.x, b.y), b.z);
}

// The cross product of vectors of magnitudes, with plus for minus.
Vec3d permanent(Vec3d a, Vec3d b) {
  return {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
}

// The float nearest to numerator / denominator, inverse being the computed 1 / denominator; false where two floats come
// into question.
bool round_quotient(const Estimate& numerator, const Estimate& denominator, double inverse, float& result) {
  const double quotient = numerator.value * inverse;
  const double size = std::abs(quotient);
  const double radius = 2 * (numerator.error + size * denominator.error) * std::abs(inverse) + 8 * kRoundoff * size;
  result = static_cast<float>(quotient - radius) + 0.0f;  // no negative zeros
  return result == static_cast<float>(quotient + radius);
}

Verdict side_verdict(const Estimates& e) {
  const bool positive = e.weight_a.is_positive() || e.weight_b.is_positive() || e.weight_c.is_positive();
  const bool negative = e.weight_a.is_negative() || e.weight_b.is_negative() || e.weight_c.is_negative();
  if (positive && negative) return Verdict::kMiss;
  if (e.weight_a.is_unsure() || e.weight_b.is_unsure() || e.weight_c.is_unsure()) return Verdict::kUnsure;
  return positive || negative ? Verdict::kHit : Verdict::kMiss;  // all zero: a zero-area triangle or one seen edge-on
}

Verdict verdict(const Estimates& e, const Ray& ray, Hit& hit) {
  const Verdict side = side_verdict(e);
  if (side != Verdict::kHit) return side;
  if (std::abs(e.sum.value) <= 4 * e.sum.error) return Verdict::kUnsure;
  const double inverse = 1 / e.sum.value;
  Hit result = hit;
  // One branch for all three: they rarely fail.
  const bool t_is_sure = round_quotient(e.numerator, e.sum, inverse, result.t);
  const bool u_is_sure = round_quotient(e.weight_b, e.sum, inverse, result.u);
  const bool v_is_sure = round_quotient(e.weight_c, e.sum, inverse, result.v);
  if (t_is_sure && !(ray.tmin <= result.t && result.t <= ray.tmax)) return Verdict::kMiss;
  if (!(t_is_sure & u_is_sure & v_is_sure)) return Verdict::kUnsure;
  hit = result;
  return Verdict::kHit;
}

// Bounds from the terms themselves: terms that vanish (rays along an axis, coordinates in common) cost no certainty.
[[gnu::noinline]] Verdict careful_verdict(const Edges& edges, Estimates e, const Ray& ray, Hit& hit) {
  const Vec3d direction = absolute(edges.direction), to_a = absolute(edges.to_a);
  const Vec3d ab = absolute(edges.ab), ac = absolute(edges.ac);
  const Vec3d moment = permanent(direction, to_a), normal = permanent(ab, ac);
  e.weight_b.error = kRelativeError * dot(moment, ac);
  e.weight_c.error = kRelativeError * dot(moment, ab);
  e.sum.error = kRelativeError * dot(direction, normal);
  e.numerator.error = kRelativeError * dot(to_a, normal);
  e.weight_a.error = e.sum.error + e.weight_b.error + e.weight_c.error +
                     2 * kRoundoff * (std::abs(e.sum.value) + std::abs(e.weight_b.value) + std::abs(e.weight_c.value));
  return verdict(e, ray, hit);
}

}  // namespace

bool intersect_triangle(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, Hit& hit) {
  const Vec3d corner = to_double(a);
  const Edges edges{to_double(ray.direction), corner - to_double(ray.origin), to_double(b) - corner,
                    to_double(c) - corner};
  const Vec3d moment = cross(edges.direction, edges.to_a), normal = cross(edges.ab, edges.ac);
  const double sum = dot(edges.direction, normal);
  const double weight_b = -dot(moment, edges.ac), weight_c = dot(moment, edges.ab);
  const double weight_a = sum - weight_b - weight_c;

  const double length = largest_component(edges.direction), distance = largest_component(edges.to_a);
  const double size = std::max(largest_component(edges.ab), largest_component(edges.ac));
  const double error = kWeightError * length * size * (distance + size);
  const double lowest = std::min(std::min(weight_a, weight_b), weight_c);
  const double highest = std::max(std::max(weight_a, weight_b), weight_c);
  if (lowest < -error && highest > error) return false;

  const Estimates estimates{{weight_a, error},
                            {weight_b, error},
                            {weight_c, error},
                            {sum, kDeterminantError * length * size * size},
                            {dot(edges.to_a, normal), kDeterminantError * distance * size * size}};
  Verdict answer = verdict(estimates, ray, hit);
  if (answer == Verdict::kUnsure) answer = careful_verdict(edges, estimates, ray, hit);
  if (answer != Verdict::kUnsure) return answer == Verdict::kHit;
  const std::optional<bool> small = intersect_triangle_small(ray, a, b, c, hit);
  return small ? *small : intersect_triangle_exact(ray, a, b, c, hit);
}

}  // namespace raygrain

#include "geometry/triangle_small.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace raygrain {
namespace {

using Wide = __int128;
using Magnitude = unsigned __int128;

constexpr int kMantissaBits = 24;
constexpr int kLowestExponent = -149;  // of the least positive float

// Coordinates are integers of up to W bits in a common unit, those of the direction of up to W_d bits in theirs.
// Differences have W + 1 bits, a determinant of three of them is below 6 * 2^(3W + 3), the sum of three determinants
// with the direction below 18 * 2^(W_d + 2W + 2): for W <= 40 and W_d + 2W <= 120 both are below 2^127. W_d <= 62, so
// that the direction's integers have 64 bits.
constexpr int kMostBits = 40, kMostBitsOfDirection = 62, kMostBitsTogether = 120;

struct Parts {
  int64_t mantissa;
  int exponent;  // x = mantissa * 2^exponent
};

Parts parts_of(float x) {
  const auto bits = std::bit_cast<uint32_t>(x);
  const auto field = static_cast<int>(bits >> 23 & 0xff);
  const auto fraction = static_cast<int64_t>(bits & 0x7fffff);
  const int64_t mantissa = field == 0 ? fraction : fraction | 0x800000;
  return {(bits >> 31) != 0 ? -mantissa : mantissa, std::max(field, 1) - 150};
}

/// The unit of numbers, as a power of two, and how many bits the largest has in it.
struct Scale {
  int unit = 1000, top = -1000;

  void add(float x) {
    const Parts parts = parts_of(x);
    if (parts.mantissa == 0) return;
    const auto size = static_cast<uint64_t>(std::abs(parts.mantissa));
    unit = std::min(unit, parts.exponent + std::countr_zero(size));
    top = std::max(top, parts.exponent + static_cast<int>(std::bit_width(size)));
  }
  int bits() const { return std::max(top - unit, 0); }
  int64_t in_units(float x) const {
    const Parts parts = parts_of(x);
    const int shift = parts.exponent - unit;
    return shift >= 0 ? parts.mantissa * (int64_t{1} << std::min(shift, 62)) : parts.mantissa >> std::min(-shift, 62);
  }
};

struct Vector {
  int64_t x, y, z;
};

Vector difference(const Scale& scale, Vec3 p, Vec3 o) {
  return {scale.in_units(p.x) - scale.in_units(o.x), scale.in_units(p.y) - scale.in_units(o.y),
          scale.in_units(p.z) - scale.in_units(o.z)};
}

Wide product(int64_t a, int64_t b) {
  return static_cast<Wide>(a) * b;
}

Wide determinant(const Vector& a, const Vector& b, const Vector& c) {
  return (product(b.y, c.z) - product(b.z, c.y)) * a.x + (product(b.z, c.x) - product(b.x, c.z)) * a.y +
         (product(b.x, c.y) - product(b.y, c.x)) * a.z;
}

int bit_width(Magnitude x) {
  const auto high = static_cast<uint64_t>(x >> 64), low = static_cast<uint64_t>(x);
  return static_cast<int>(high != 0 ? 64 + std::bit_width(high) : std::bit_width(low));
}

/// numerator / denominator * 2^unit rounded to the nearest float, ties to even; zero is always positive.
float rounded_quotient(Wide numerator, Wide denominator, int unit) {
  if (numerator == 0) return 0;
  auto a = static_cast<Magnitude>(numerator < 0 ? -numerator : numerator);
  auto b = static_cast<Magnitude>(denominator < 0 ? -denominator : denominator);
  // To 1 <= a / b < 2 by shifting; neither grows beyond 2^128.
  int exponent = bit_width(a) - bit_width(b);
  if (exponent >= 0 ? a < (b << exponent) : (a << -exponent) < b) --exponent;
  if (exponent >= 0)
    b <<= exponent;
  else
    a <<= -exponent;
  // The last place of floats of this size, and the bits down to there: none, or negative, for what is below them all.
  const int place = std::max(exponent + unit - (kMantissaBits - 1), kLowestExponent);
  const int bits = exponent + unit - place + 1;
  if (bits < 0) return 0;
  uint32_t mantissa = 0;
  for (int i = 0; i < bits; ++i) {
    const bool bit = a >= b;
    mantissa = mantissa << 1 | (bit ? 1u : 0u);
    if (bit) a -= b;
    a <<= 1;
  }
  // `a` is now twice the remainder.
  if (a > b || (a == b && mantissa % 2 == 1)) ++mantissa;
  const float magnitude = std::ldexp(static_cast<float>(mantissa), place);  // exact, or infinite
  return (numerator < 0) == (denominator < 0) ? magnitude : -magnitude + 0.0f;
}

}  // namespace

std::optional<bool> intersect_triangle_small(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, Hit& hit) {
  Scale place, way;
  for (const Vec3 p : {ray.origin, a, b, c}) place.add(p.x), place.add(p.y), place.add(p.z);
  way.add(ray.direction.x), way.add(ray.direction.y), way.add(ray.direction.z);
  if (place.bits() > kMostBits || way.bits() > kMostBitsOfDirection ||
      way.bits() + 2 * place.bits() > kMostBitsTogether)
    return {};
  const Vector d{way.in_units(ray.direction.x), way.in_units(ray.direction.y), way.in_units(ray.direction.z)};
  const Vector oa = difference(place, a, ray.origin), ob = difference(place, b, ray.origin),
               oc = difference(place, c, ray.origin);
  const Wide weight_a = determinant(d, ob, oc), weight_b = determinant(d, oc, oa), weight_c = determinant(d, oa, ob);
  const bool positive = weight_a > 0 || weight_b > 0 || weight_c > 0;
  const bool negative = weight_a < 0 || weight_b < 0 || weight_c < 0;
  if (positive == negative) return false;  // opposite signs, or all zero: then their sum is zero too
  const Wide sum = weight_a + weight_b + weight_c;
  const float t = rounded_quotient(determinant(oa, ob, oc), sum, place.unit - way.unit);
  if (!(ray.tmin <= t && t <= ray.tmax)) return false;
  hit.t = t;
  hit.u = rounded_quotient(weight_b, sum, 0);
  hit.v = rounded_quotient(weight_c, sum, 0);
  return true;
}

}  // namespace raygrain

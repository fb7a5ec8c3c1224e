// The definition, in integers. Every float is a multiple of 2^-149 below 2^128: an integer of at most 277 bits.
// Differences take 278, the determinants of three of them at most 837, their sums 839, and the shifts of the rounding
// division 25 more: 1024 bits hold everything.
#include <cmath>

#include <boost/multiprecision/cpp_int.hpp>

#include "raygrain/triangle.h"

namespace raygrain {
namespace {

using boost::multiprecision::msb;
using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<1024, 1024, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;

constexpr int kMantissaBits = 24;
constexpr int kLowestExponent = -149;  // of the least positive float

// x / 2^-149.
Integer to_integer(float x) {
  int exponent = 0;
  const float fraction = std::frexp(x, &exponent);  // in [0.5, 1), denormals included
  const int shift = exponent - kMantissaBits - kLowestExponent;
  const Integer mantissa = static_cast<int32_t>(std::ldexp(fraction, kMantissaBits));
  return shift >= 0 ? mantissa << shift : mantissa >> -shift;  // a denormal's low bits are zero
}

struct IntegerVector {
  Integer x, y, z;
};

IntegerVector to_integers(Vec3 a) {
  return {to_integer(a.x), to_integer(a.y), to_integer(a.z)};
}

IntegerVector difference(const IntegerVector& a, const IntegerVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

Integer determinant(const IntegerVector& a, const IntegerVector& b, const IntegerVector& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

// floor(log2(a / b)) for positive a and b.
int exponent_of_quotient(const Integer& a, const Integer& b) {
  const int exponent = static_cast<int>(msb(a)) - static_cast<int>(msb(b));
  const bool too_high = exponent >= 0 ? a < (b << exponent) : (a << -exponent) < b;
  return too_high ? exponent - 1 : exponent;
}

// numerator / denominator rounded to the nearest float, ties to even; zero is always positive.
float rounded_quotient(const Integer& numerator, const Integer& denominator) {
  if (numerator.is_zero()) return 0;
  Integer a = abs(numerator), b = abs(denominator);
  const int unit = std::max(exponent_of_quotient(a, b) - (kMantissaBits - 1), kLowestExponent);
  if (unit >= 0)
    b <<= unit;
  else
    a <<= -unit;
  Integer quotient, remainder;
  divide_qr(a, b, quotient, remainder);
  auto mantissa = static_cast<uint32_t>(quotient);
  const int above_half = Integer(remainder << 1).compare(b);
  if (above_half > 0 || (above_half == 0 && mantissa % 2 == 1)) ++mantissa;
  const float magnitude = std::ldexp(static_cast<float>(mantissa), unit);  // exact, or infinite
  return numerator.sign() == denominator.sign() ? magnitude : -magnitude + 0.0f;
}

}  // namespace

bool intersect_triangle_exact(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, Hit& hit) {
  const IntegerVector d = to_integers(ray.direction), o = to_integers(ray.origin);
  const IntegerVector oa = difference(to_integers(a), o), ob = difference(to_integers(b), o),
                      oc = difference(to_integers(c), o);
  const Integer weight_a = determinant(d, ob, oc), weight_b = determinant(d, oc, oa), weight_c = determinant(d, oa, ob);
  const bool positive = weight_a.sign() > 0 || weight_b.sign() > 0 || weight_c.sign() > 0;
  const bool negative = weight_a.sign() < 0 || weight_b.sign() < 0 || weight_c.sign() < 0;
  if (positive == negative) return false;  // opposite signs, or all zero: then their sum is zero too
  const Integer sum = weight_a + weight_b + weight_c;
  const float t = rounded_quotient(determinant(oa, ob, oc), sum);
  if (!(ray.tmin <= t && t <= ray.tmax)) return false;
  hit.t = t;
  hit.u = rounded_quotient(weight_b, sum);
  hit.v = rounded_quotient(weight_c, sum);
  return true;
}

}  // namespace raygrain

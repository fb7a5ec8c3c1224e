// Three-component vectors: float for everything a user hands over, double for derived geometry.
#pragma once

#include <cmath>
#include <limits>

namespace raygrain {

inline constexpr float kInf = std::numeric_limits<float>::infinity();

template <class Scalar>
struct Vector3 {
  Scalar x = 0, y = 0, z = 0;

  constexpr Scalar operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
  constexpr Scalar& operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }

  friend constexpr Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vector3 operator-(Vector3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vector3 operator-(Vector3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vector3 operator*(Vector3 a, Scalar s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vector3 operator*(Scalar s, Vector3 a) { return a * s; }
  friend constexpr Vector3 operator/(Vector3 a, Scalar s) { return {a.x / s, a.y / s, a.z / s}; }
  friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

using Vec3 = Vector3<float>;
using Vec3d = Vector3<double>;

template <class Scalar>
constexpr Scalar dot(Vector3<Scalar> a, Vector3<Scalar> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Scalar>
constexpr Vector3<Scalar> cross(Vector3<Scalar> a, Vector3<Scalar> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Scalar>
Scalar length(Vector3<Scalar> a) {
  return std::sqrt(dot(a, a));
}

/// The unit vector along `a`. `a` must not be zero; its square must not overflow.
template <class Scalar>
Vector3<Scalar> normalized(Vector3<Scalar> a) {
  return a / length(a);
}

template <class Scalar>
constexpr Vector3<Scalar> component_min(Vector3<Scalar> a, Vector3<Scalar> b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

template <class Scalar>
constexpr Vector3<Scalar> component_max(Vector3<Scalar> a, Vector3<Scalar> b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

template <class Scalar>
bool is_finite(Vector3<Scalar> a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

constexpr Vec3d to_double(Vec3 a) {
  return {a.x, a.y, a.z};
}
constexpr Vec3 to_float(Vec3d a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

}  // namespace raygrain

// SPDX-License-Identifier: Apache-2.0
// Three-vectors and 3x3 matrices. Plain structs, no expression templates: the same operations in
// the same order on every target and at every optimisation level, which bit-identical wrenches
// need.
#pragma once

namespace palpate {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};
};
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
constexpr Vec3<T> operator+(Vec3<T> a, Vec3<T> b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
constexpr Vec3<T> operator-(Vec3<T> a, Vec3<T> b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
constexpr Vec3<T> operator-(Vec3<T> a) noexcept {
  return {-a.x, -a.y, -a.z};
}
template <class T>
constexpr Vec3<T> operator*(T s, Vec3<T> a) noexcept {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
constexpr Vec3<T>& operator+=(Vec3<T>& a, Vec3<T> b) noexcept {
  return a = a + b;
}
template <class T>
constexpr Vec3<T>& operator-=(Vec3<T>& a, Vec3<T> b) noexcept {
  return a = a - b;
}
template <class T>
constexpr bool operator==(Vec3<T> a, Vec3<T> b) noexcept {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr T squared_norm(Vec3<T> a) noexcept {
  return dot(a, a);
}

/// Correctly rounded on every target: compiles to the square-root instruction or the C library's
/// sqrt.
inline double sqrt_of(double v) noexcept { return __builtin_sqrt(v); }
inline float sqrt_of(float v) noexcept { return __builtin_sqrtf(v); }

template <class T>
inline T norm(Vec3<T> a) noexcept {
  return sqrt_of(squared_norm(a));
}

/// A unit vector across `v`, which is not 0.
inline Vec3d across(Vec3d v) noexcept {
  const double x = v.x * v.x;
  const double y = v.y * v.y;
  const double z = v.z * v.z;
  const Vec3d least = x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  const Vec3d out = cross(v, least);
  return (1 / norm(out)) * out;
}

template <class To, class From>
constexpr Vec3<To> vec_cast(Vec3<From> a) noexcept {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

/// Row-major 3x3 matrix.
template <class T>
struct Mat3 {
  Vec3<T> row0{T(1), T(0), T(0)}, row1{T(0), T(1), T(0)}, row2{T(0), T(0), T(1)};
};
using Mat3f = Mat3<float>;
using Mat3d = Mat3<double>;

template <class T>
constexpr Vec3<T> operator*(const Mat3<T>& m, Vec3<T> v) noexcept {
  return {dot(m.row0, v), dot(m.row1, v), dot(m.row2, v)};
}
template <class T>
constexpr Mat3<T> transpose(const Mat3<T>& m) noexcept {
  return {{m.row0.x, m.row1.x, m.row2.x},
          {m.row0.y, m.row1.y, m.row2.y},
          {m.row0.z, m.row1.z, m.row2.z}};
}
template <class T>
constexpr Mat3<T> operator*(const Mat3<T>& a, const Mat3<T>& b) noexcept {
  const Mat3<T> t = transpose(b);
  return {{dot(a.row0, t.row0), dot(a.row0, t.row1), dot(a.row0, t.row2)},
          {dot(a.row1, t.row0), dot(a.row1, t.row1), dot(a.row1, t.row2)},
          {dot(a.row2, t.row0), dot(a.row2, t.row1), dot(a.row2, t.row2)}};
}

/// Three floats, as images keep points and directions.
constexpr Vec3d vec3d(const float* xyz) noexcept {
  return {static_cast<double>(xyz[0]), static_cast<double>(xyz[1]), static_cast<double>(xyz[2])};
}

}  // namespace palpate

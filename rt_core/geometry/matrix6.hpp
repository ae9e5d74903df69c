// SPDX-License-Identifier: Apache-2.0
// Symmetric 6x6 matrices over twists and wrenches: what stiffness, damping and inertia are.
#pragma once

#include <array>
#include <cstddef>

#include "rt_core/geometry/pose.hpp"

namespace palpate {

/// Linear part, then angular; world axes, about the point that the context names.
using Vec6 = std::array<double, 6>;

constexpr Vec6 vec6(Vec3d linear, Vec3d angular) noexcept {
  return {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
}
constexpr Vec3d linear(const Vec6& v) noexcept { return {v[0], v[1], v[2]}; }
constexpr Vec3d angular(const Vec6& v) noexcept { return {v[3], v[4], v[5]}; }

/// Only the lower triangle is kept.
class Matrix6 {
 public:
  static constexpr std::size_t kSize = 6;

  [[nodiscard]] constexpr double at(std::size_t row, std::size_t column) const noexcept {
    return row >= column ? lower_[index(row, column)] : lower_[index(column, row)];
  }
  constexpr void add(std::size_t row, std::size_t column, double value) noexcept {
    lower_[row >= column ? index(row, column) : index(column, row)] += value;
  }

  /// Adds scale * v v^T: positive semidefinite where scale >= 0.
  constexpr void add_square(const Vec6& v, double scale) noexcept {
    for (std::size_t r = 0; r < kSize; ++r) {
      const double s = scale * v[r];
      for (std::size_t c = 0; c <= r; ++c) lower_[index(r, c)] += s * v[c];
    }
  }

  constexpr void add(const Matrix6& other, double scale) noexcept {
    for (std::size_t i = 0; i < lower_.size(); ++i) lower_[i] += scale * other.lower_[i];
  }

  constexpr void add_diagonal(double linear_part, double angular_part) noexcept {
    for (std::size_t i = 0; i < kSize; ++i) add(i, i, i < 3 ? linear_part : angular_part);
  }

  [[nodiscard]] constexpr Vec6 operator*(const Vec6& v) const noexcept {
    Vec6 out{};
    for (std::size_t r = 0; r < kSize; ++r) {
      for (std::size_t c = 0; c < kSize; ++c) out[r] += at(r, c) * v[c];
    }
    return out;
  }

  /// x with (this) x = b, for positive definite matrices: LDL^T without pivoting, always the same
  /// number of operations. Rows whose pivot is not positive (the matrix was not definite) get 0.
  [[nodiscard]] constexpr Vec6 solve(const Vec6& b) const noexcept {
    std::array<double, 21> l = lower_;  // factors below the diagonal, pivots on it
    Vec6 x = b;
    for (std::size_t c = 0; c < kSize; ++c) {
      for (std::size_t k = 0; k < c; ++k) {
        const double weighted = l[index(c, k)] * l[index(k, k)];
        for (std::size_t r = c; r < kSize; ++r) l[index(r, c)] -= weighted * l[index(r, k)];
      }
      const double pivot = l[index(c, c)];
      const double inverse = pivot > 0 ? 1 / pivot : 0;
      for (std::size_t r = c + 1; r < kSize; ++r) l[index(r, c)] *= inverse;
      for (std::size_t r = c + 1; r < kSize; ++r) x[r] -= l[index(r, c)] * x[c];
    }
    for (std::size_t r = kSize; r-- > 0;) {
      const double pivot = l[index(r, r)];
      x[r] = pivot > 0 ? x[r] / pivot : 0;
      for (std::size_t k = r + 1; k < kSize; ++k) x[r] -= l[index(k, r)] * x[k];
    }
    return x;
  }

 private:
  static constexpr std::size_t index(std::size_t row, std::size_t column) noexcept {
    return row * (row + 1) / 2 + column;
  }
  std::array<double, 21> lower_{};
};

}  // namespace palpate

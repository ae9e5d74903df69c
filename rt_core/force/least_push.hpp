// SPDX-License-Identifier: Apache-2.0
// The force of a set of contacts: the least push that satisfies all of them (docs/CONTACT.md).
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::force {

/// A contact as the least push sees it: a direction in which the tool is pushed, and how far.
struct PushConstraint {
  Vec3d normal{};       ///< unit
  double strength = 0;  ///< any length unit; may be negative
};

/// A vector v and a symmetric matrix S, the squeeze. The push in direction n is n.v + n.S n.
struct Push {
  Vec3d vector{};
  Vec3d squeeze_diagonal{};  ///< S_xx, S_yy, S_zz
  Vec3d squeeze_mixed{};     ///< S_xy, S_yz, S_zx

  [[nodiscard]] double along(Vec3d n) const noexcept { return dot(n, vector) + squeeze_along(n); }
  /// n.S n
  [[nodiscard]] double squeeze_along(Vec3d n) const noexcept {
    const Vec3d square{n.x * n.x, n.y * n.y, n.z * n.z};
    const Vec3d mixed{n.x * n.y, n.y * n.z, n.z * n.x};
    return dot(square, squeeze_diagonal) + 2 * dot(mixed, squeeze_mixed);
  }
  /// S n
  [[nodiscard]] Vec3d squeezed(Vec3d n) const noexcept {
    return {squeeze_diagonal.x * n.x + squeeze_mixed.x * n.y + squeeze_mixed.z * n.z,
            squeeze_mixed.x * n.x + squeeze_diagonal.y * n.y + squeeze_mixed.y * n.z,
            squeeze_mixed.z * n.x + squeeze_mixed.y * n.y + squeeze_diagonal.z * n.z};
  }
  [[nodiscard]] double trace() const noexcept {
    return squeeze_diagonal.x + squeeze_diagonal.y + squeeze_diagonal.z;
  }
};

/// The push has nine components, so nine contacts are enough to carry it; where more of them hold
/// with equality, rounding may leave a tenth.
inline constexpr std::uint32_t kMostCarrying = 10;

/// A contact whose constraint holds with equality.
struct Carrying {
  std::uint32_t index = 0;  ///< into the constraints
  double multiplier = 0;    ///< lambda > 0: Push::vector is the sum of multiplier * normal
};

enum class PushStatus : std::uint8_t {
  solved,
  step_limit,  ///< some constraint is still violated, by PushResult::violation
};

struct PushResult {
  Push push;
  Carrying carrying[kMostCarrying];
  std::uint32_t carrying_count = 0;
  double violation = 0;  ///< largest strength - push.along(normal), >= 0
  PushStatus status = PushStatus::solved;

  [[nodiscard]] std::span<const Carrying> carrying_contacts() const noexcept {
    return {carrying, carrying_count};
  }
};

/// Constraints that enter in one solution, at most.
inline constexpr std::uint32_t kPushSteps = 100;

/// Minimises |v|^2 / 2 + |S|_F^2 / 2 subject to n_i.v + n_i.S n_i >= strength_i for all i.
///
/// Dual active set: the most violated constraint enters, constraints whose multiplier would become
/// negative leave (Lawson and Hanson 1974, ch. 23; Goldfarb and Idnani 1983). The Gram matrix of
/// two constraints is c + c^2, c the cosine between their normals. The answer is unique; what it is
/// started from changes rounding only.
///
/// @param constraints  parallel, coincident and opposed normals are allowed
/// @param start        indices to begin with, may be empty: those that carried last time
/// Rounding: constraints hold to 1e-10 of the largest strength.
/// Cost: at most kPushSteps passes over the constraints; no memory, bounded stack.
[[nodiscard]] PushResult least_push(std::span<const PushConstraint> constraints,
                                    std::span<const std::uint32_t> start = {}) noexcept;

/// How far the vector of a push may be from that of more or stronger constraints, which it violates
/// by at most `missing` >= 0: with S the squeeze, S + missing I satisfies them, and the projection
/// on the smaller convex set is no nearer to the origin. O(1)
[[nodiscard]] double push_error(const Push& push, double missing) noexcept;
/// The largest `missing` of which push_error() is no more than `error`. O(1)
[[nodiscard]] double tolerated_violation(const Push& push, double error) noexcept;

/// The largest vector of a push that constraints of at most `strength` >= 0 can have, however many:
/// S = strength I alone satisfies them all. O(1)
[[nodiscard]] constexpr double most_push(double strength) noexcept {
  constexpr double kSqrt3 = 1.7320508075688773;
  return kSqrt3 * strength;
}

/// By how much two pushes differ in any direction, at most. O(1)
[[nodiscard]] double difference(const Push& a, const Push& b) noexcept;

}  // namespace palpate::force

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/least_push.hpp"

namespace palpate::force {
namespace {

/// Constraints count as held when they are violated by less, as a share of the largest strength.
constexpr double kHeld = 1e-10;
/// Added to the diagonal of the Gram matrix: coincident normals stay solvable.
constexpr double kRidge = 1e-11;
constexpr double kLeastPivot = 1e-14;

double gram(Vec3d a, Vec3d b) noexcept {
  const double c = dot(a, b);
  return c + c * c;
}

/// Constraints that may carry, with their multipliers.
class WorkingSet {
 public:
  explicit WorkingSet(std::span<const PushConstraint> all) noexcept : all_(all) {}

  [[nodiscard]] bool full() const noexcept { return count_ == kMostCarrying; }
  [[nodiscard]] bool has(std::uint32_t index) const noexcept {
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (index_[i] == index) return true;
    }
    return false;
  }

  /// Adds a constraint and finds the multipliers of all: the minimum over this set alone.
  void add(std::uint32_t index) noexcept {
    index_[count_] = index;
    multiplier_[count_] = 0;
    for (std::uint32_t i = 0; i <= count_; ++i) {
      gram_[count_][i] = gram_[i][count_] =
          gram(all_[index].normal, all_[index_[i]].normal) + (i == count_ ? kRidge : 0);
    }
    ++count_;
    settle();
  }

  [[nodiscard]] Push push() const noexcept {
    Push out;
    for (std::uint32_t i = 0; i < count_; ++i) {
      const Vec3d n = all_[index_[i]].normal;
      const Vec3d weighted = multiplier_[i] * n;
      out.vector += weighted;
      out.squeeze_diagonal += {weighted.x * n.x, weighted.y * n.y, weighted.z * n.z};
      out.squeeze_mixed += {weighted.x * n.y, weighted.y * n.z, weighted.z * n.x};
    }
    return out;
  }

  void write(PushResult& out) const noexcept {
    out.carrying_count = count_;
    for (std::uint32_t i = 0; i < count_; ++i) out.carrying[i] = {index_[i], multiplier_[i]};
  }

 private:
  /// Moves towards the multipliers that satisfy all with equality; where one would become negative
  /// on the way, its constraint leaves. Each pass removes one, so there are at most kMostCarrying.
  void settle() noexcept {
    for (std::uint32_t pass = 0; pass < kMostCarrying && count_ > 0; ++pass) {
      double wanted[kMostCarrying];
      solve(wanted);
      double part = 1;
      std::uint32_t leaves = count_;
      for (std::uint32_t i = 0; i < count_; ++i) {
        if (wanted[i] > 0) continue;
        const double to_zero =
            multiplier_[i] > 0 ? multiplier_[i] / (multiplier_[i] - wanted[i]) : 0;
        if (to_zero < part || leaves == count_) {
          part = to_zero;
          leaves = i;
        }
      }
      for (std::uint32_t i = 0; i < count_; ++i) {
        multiplier_[i] =
            leaves == count_ ? wanted[i] : multiplier_[i] + part * (wanted[i] - multiplier_[i]);
      }
      if (leaves == count_) return;
      remove(leaves);
    }
  }

  void remove(std::uint32_t at) noexcept {
    --count_;
    for (std::uint32_t i = at; i < count_; ++i) {
      index_[i] = index_[i + 1];
      multiplier_[i] = multiplier_[i + 1];
    }
    for (std::uint32_t row = 0; row < count_; ++row) {
      const std::uint32_t from_row = row < at ? row : row + 1;
      for (std::uint32_t column = 0; column < count_; ++column) {
        gram_[row][column] = gram_[from_row][column < at ? column : column + 1];
      }
    }
  }

  /// Cholesky.
  void solve(double (&out)[kMostCarrying]) const noexcept {
    double factor[kMostCarrying][kMostCarrying];
    for (std::uint32_t i = 0; i < count_; ++i) {
      double y = all_[index_[i]].strength;
      for (std::uint32_t j = 0; j <= i; ++j) {
        double q = gram_[i][j];
        for (std::uint32_t k = 0; k < j; ++k) q -= factor[i][k] * factor[j][k];
        if (j < i) {
          factor[i][j] = q / factor[j][j];
        } else {
          factor[i][i] = sqrt_of(q > kLeastPivot ? q : kLeastPivot);
        }
      }
      for (std::uint32_t k = 0; k < i; ++k) y -= factor[i][k] * out[k];
      out[i] = y / factor[i][i];
    }
    for (std::uint32_t i = count_; i-- > 0;) {
      double y = out[i];
      for (std::uint32_t k = i + 1; k < count_; ++k) y -= factor[k][i] * out[k];
      out[i] = y / factor[i][i];
    }
  }

  std::span<const PushConstraint> all_;
  std::uint32_t index_[kMostCarrying] = {};
  double multiplier_[kMostCarrying] = {};
  double gram_[kMostCarrying][kMostCarrying] = {};
  std::uint32_t count_ = 0;
};

struct Violation {
  std::uint32_t index = 0;
  double size = 0;
};

Violation most_violated(std::span<const PushConstraint> all, const Push& push) noexcept {
  Violation worst;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const double size = all[i].strength - push.along(all[i].normal);
    if (size > worst.size) worst = {i, size};
  }
  return worst;
}

}  // namespace

PushResult least_push(std::span<const PushConstraint> constraints,
                      std::span<const std::uint32_t> start) noexcept {
  PushResult out;
  double largest = 0;
  for (const PushConstraint& c : constraints) largest = c.strength > largest ? c.strength : largest;
  if (!(largest > 0)) return out;
  WorkingSet set(constraints);
  for (const std::uint32_t index : start) {
    if (index < constraints.size() && !set.full() && !set.has(index) &&
        constraints[index].strength > set.push().along(constraints[index].normal)) {
      set.add(index);
    }
  }
  out.status = PushStatus::step_limit;
  for (std::uint32_t step = 0; step < kPushSteps; ++step) {
    out.push = set.push();
    const Violation worst = most_violated(constraints, out.push);
    out.violation = worst.size;
    if (worst.size <= kHeld * largest || set.has(worst.index) || set.full()) {
      if (worst.size <= kHeld * largest || set.has(worst.index)) out.status = PushStatus::solved;
      break;
    }
    set.add(worst.index);
  }
  set.write(out);
  return out;
}

double push_error(const Push& push, double missing) noexcept {
  const double trace = push.trace() > 0 ? push.trace() : 0;
  return sqrt_of(2 * missing * trace + 3 * missing * missing);
}

double tolerated_violation(const Push& push, double error) noexcept {
  const double trace = push.trace() > 0 ? push.trace() : 0;
  return (sqrt_of(trace * trace + 3 * error * error) - trace) / 3;
}

double difference(const Push& a, const Push& b) noexcept {
  const Vec3d diagonal = a.squeeze_diagonal - b.squeeze_diagonal;
  const Vec3d mixed = a.squeeze_mixed - b.squeeze_mixed;
  return norm(a.vector - b.vector) + sqrt_of(squared_norm(diagonal) + 2 * squared_norm(mixed));
}

}  // namespace palpate::force

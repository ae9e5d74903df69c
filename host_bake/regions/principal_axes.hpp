// SPDX-License-Identifier: GPL-3.0-or-later
// Principal axes of a cloud of points.
#pragma once

#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// Sums from which the covariance of points follows; add() each, then ask principal_axes().
struct Moments {
  double count = 0;
  Vec3d first{};
  Mat3d second{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

  void add(Vec3d p) {
    count += 1;
    first += p;
    second.row0 += p.x * p;
    second.row1 += p.y * p;
    second.row2 += p.z * p;
  }
};

/// Orthonormal, right-handed rows: directions of least, middle and largest variance. Jacobi's
/// method on the covariance; the same bits on every host. Any cloud gives three axes.
Mat3d principal_axes(const Moments& moments);

}  // namespace palpate::bake

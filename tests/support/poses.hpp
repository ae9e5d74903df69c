// SPDX-License-Identifier: Apache-2.0
// Poses along an axis, in m.
#pragma once

#include "rt_core/geometry/pose.hpp"

namespace palpate::test {

inline Pose at_x(double x_m) { return {{x_m, 0, 0}, {}}; }
inline Pose at_z(double z_m) { return {{0, 0, z_m}, {}}; }

}  // namespace palpate::test

// SPDX-License-Identifier: GPL-3.0-or-later
// How hard one contact pushes the tool.
#pragma once

#include "rt_core/palpate_rt.hpp"

namespace palpate::realtime {

/// Newtons along its normal, before limits; 0 where it carries nothing.
inline double contact_force(const Contact& c, const Settings& s) noexcept {
  return c.weight * s.stiffness_N_per_m * (s.delta_m - c.distance_m);
}

}  // namespace palpate::realtime

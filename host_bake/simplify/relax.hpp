// SPDX-License-Identifier: GPL-3.0-or-later
// Relaxation by second-order divided differences (Guskov, Sweldens, Schroeder 1999, Sec. 3).
#pragma once

#include <span>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// The position of an inner vertex that minimises the sum of squared second differences over the
/// edges whose flaps contain it: its spokes and the rim of its faces.
///
/// The weights come from the flaps unfolded about their edges, as they lie now (`centre` included);
/// flaps without area do not count. Linear fields over a plane are reproduced. Where no flap is
/// left the centre stays.
/// @param centre  the vertex
/// @param ring    its neighbours, counter-clockwise; face i is (centre, ring[i], ring[i + 1])
/// @param far     [ring] the vertex across the rim edge ring[i], ring[i + 1]
/// @param has_far [ring] whether there is one
Vec3d relaxed(Vec3d centre, std::span<const Vec3d> ring, std::span<const Vec3d> far,
              std::span<const char> has_far);

}  // namespace palpate::bake

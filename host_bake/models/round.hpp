// SPDX-License-Identifier: GPL-3.0-or-later
// Star-shaped bodies and cups: surfaces given by a radius for each direction. u turns about z, v
// goes from the pole at -z (v = 0) to the pole at +z (v = 1) in equal angles.
#pragma once

#include <functional>
#include <span>

#include "host_bake/models/loft.hpp"

namespace palpate::bake {

/// Distance from the origin to the surface, metres, along a unit vector.
using Radius = std::function<double(const Point& direction)>;

/// Unit vector at (u, v).
Point direction(double u, double v);

/// The surface of a star-shaped body.
Surface star_surface(Radius radius);

/// The unit sphere: what rows are planned on when surfaces of slightly different radius are to
/// share them.
Surface unit_sphere();

/// A cup of two walls: `inner_rows`, from the pole at -z to the row of the rim, carry the inner
/// wall; the rounded rim and the outer wall are planned so that the whole has `vertices`.
Mesh cup(const Radius& inner, const Radius& outer, std::span<const Row> inner_rows,
         std::size_t vertices);

}  // namespace palpate::bake

// SPDX-License-Identifier: Apache-2.0
// Is one surface wholly inside another? Distances and crossings of triangles do not tell.
#pragma once

#include <cstdint>

#include "rt_core/levels/body_pair.hpp"
#include "rt_core/regions/search.hpp"

namespace palpate::regions {

struct Work;

enum class Side : std::uint8_t { unknown, outside, inside };

/// What is kept of a pair from tick to tick.
struct Containment {
  bool inside = false;   ///< one body is inside the other
  bool doubtful = true;  ///< a jump, or surfaces that may have passed through each other since
  Witness nearest;       ///< inside, and farther than delta from the surface: the nearest pair
};

/// On which side of a closed surface a point lies: inside where a ray from it passes through more
/// triangles outwards than inwards. Shared edges are passed once, for both triangles see them in
/// the same numbers; a ray that meets an edge exactly is given up for another direction. A surface
/// that faces inwards, a room, has no inside.
/// @param point  image coordinates of the body
/// An open surface has no inside either. Unknown where the budget or all directions are used up.
/// Cost: a unit for each node whose box the ray passes through, for at most three rays.
[[nodiscard]] Side side_of(const Kernels& kernels, const ImageView& body, Vec3d point,
                           SearchScratch& scratch, Pace& pace) noexcept;

/// Whether a way meets no triangle of a surface. It may end on the surface, seen from inside:
/// within a thousandth of its end only triangles count through which it would go in, as those of a
/// wall without thickness. False too where the pace ends before that is known.
/// @param from, to  image coordinates of the body
/// Cost: a unit for each node whose box the way passes through.
[[nodiscard]] bool in_sight(const Kernels& kernels, const ImageView& body, Vec3d from, Vec3d to,
                            SearchScratch& scratch, Pace& pace) noexcept;

/// Side::inside where a vertex of one body is inside the other, for bodies whose triangles do not
/// cross: then the whole body is. A body of several components is not asked for: its vertex would
/// not speak for all of it.
[[nodiscard]] Side contained(const Kernels& kernels, const levels::PairState& pair,
                             SearchScratch& scratch, Pace& pace) noexcept;

/// Settles for every pair whether one body is inside the other where that is in doubt: unless they
/// cross, for surfaces that cross have no inside to speak of, and are looked at once they have
/// parted. Cost: contained(), for each pair in doubt.
void settle_sides(Work& work) noexcept;

/// Makes the nearest pair of all an active region's witness where one body is inside the other and
/// no region is near the surface. Cost: what is left of the budget at most.
void find_ways_out(Work& work) noexcept;

}  // namespace palpate::regions

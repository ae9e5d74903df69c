// SPDX-License-Identifier: GPL-3.0-or-later
// The shapes behind make_model(); its caller has checked the number of triangles. All in metres,
// all outward oriented. Mating shapes are triangulated alike where they mate when they are asked
// for the same number of triangles.
#pragma once

#include <cstddef>
#include <cstdint>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// Ball of radius 21.35 mm with 336 dimples, 0.25 mm deep, 3.7 mm wide, their rims rounded; spread
/// by repulsion from places that the seed moves. About the origin.
Mesh golf_ball(std::size_t triangles, std::uint64_t seed);

/// Cup around the same ball, open to +z, its inside the ball's surface enlarged by 0.7 %, its
/// outside smooth.
Mesh golf_shell(std::size_t triangles, std::uint64_t seed);

/// Iron: a hosel that bends into a blade with grooves along the face; the seed roughens back and
/// sole.
Mesh golf_club(std::size_t triangles, std::uint64_t seed);

/// Bone-like ball of radius 16 mm about the origin with a neck along +z; the seed makes the
/// texture.
Mesh ball_joint_head(std::size_t triangles, std::uint64_t seed);

/// Socket around the ball to 10 degrees beyond its equator, its inside the ball's surface enlarged
/// by 0.75 %.
Mesh ball_joint_cup(std::size_t triangles, std::uint64_t seed);

/// Dental arches in bite, about life size, the lower one below z = 0; the seed makes fissures and
/// gums.
Mesh jaw_lower(std::size_t triangles, std::uint64_t seed);
Mesh jaw_upper(std::size_t triangles, std::uint64_t seed);

/// Semi-axes 20, 12 and 8 mm along x, y and z; every edge is convex.
Mesh ellipsoid(std::size_t triangles, std::uint64_t seed);

/// Knurled screw along z, and a hexagonal nut on its thread; the seed turns both about z.
Mesh screw(std::size_t triangles, std::uint64_t seed);
Mesh nut(std::size_t triangles, std::uint64_t seed);

}  // namespace palpate::bake

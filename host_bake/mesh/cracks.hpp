// SPDX-License-Identifier: GPL-3.0-or-later
// Open edges whose ends nearly coincide: each face has a copy of its own of a corner that was meant
// to be one, and the copies differ. Exporters that transform a mesh facet by facet leave such
// cracks. Precondition throughout: finite coordinates, indices in range.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "host_bake/mesh/topology.hpp"

namespace palpate::bake {

/// Rounding to float32 moves a coordinate by at most this share of the radius: 2^-24, 6e-8. A file
/// of floats was rounded so, and so are the vertices of an image.
inline constexpr double kCoordinateRoundingRel = 0x1p-24;

/// Corners no farther apart than this share of the radius, 2.1e-7, coincide: twice (both corners)
/// the square root of 3 (all coordinates) times the rounding of one.
inline constexpr double kCoincideRel = 2 * 1.7320508075688772 * kCoordinateRoundingRel;

struct Welded {
  std::size_t corners = 0;              ///< vertices merged into another one
  double largest_gap_m = 0;             ///< of a corner from the one that it was merged into
  double largest_gap_rel = 0;           ///< the same, of the mesh's radius
  std::size_t collapsed_triangles = 0;  ///< dropped: two of their corners were merged
};

/// Merges corners at open edges (those of one face only) that coincide within kCoincideRel of the
/// radius. Corners are taken in the order of their coordinates: one joins the nearest taken before
/// it if that is near enough, or else stays where it is and is there for others to join. So the
/// surface does not depend on the order of corners or faces in the file, none moves farther than
/// the tolerance, and a fine border does not shrink link by link. Vertices are numbered anew by
/// their first use. A mesh without such corners stays as it is, bit for bit. O(n log n).
Welded weld_coincident(Mesh& mesh);

/// "174 corners that differed by rounding, largest gap 5.3e-09 m (1.8e-07 of the radius)", and the
/// triangles that collapsed where there are any.
std::string describe(const Welded& welded);

/// A crack is looked for up to this share of the radius ...
inline constexpr double kNearlyCoincideRel = 1e-3;
/// ... and of the length of the open edges on both sides of it.
inline constexpr double kNearlyCoincideOfEdge = 0.1;

struct Cracks {
  std::vector<Point> corners;  ///< those at the cracks, ascending
  double largest_gap_m = 0;
};

/// Corners of open edges that run side by side with both ends near each other's, and not both at
/// equal positions, as repair() leaves sheets that touch. O(n log n).
Cracks find_cracks(const Mesh& mesh, std::span<const Side> sides);

}  // namespace palpate::bake

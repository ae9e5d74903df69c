// SPDX-License-Identifier: GPL-3.0-or-later
// Detail below perception, left out before anything is baked: fewer triangles within a distance of
// the mesh. Beyond the paper, whose levels follow resolutions: their largest deviation is a third
// of a contact tolerance where a third of the triangles are gone.
#pragma once

#include "host_bake/base/error.hpp"
#include "host_bake/mesh/check.hpp"
#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// The most that can be left out: beyond it nothing is left of an object.
inline constexpr double kMostDeviation = 0.1;

struct Reduced {
  NormalMesh mesh;      ///< centre and radius of the original
  CheckReport check;    ///< of this mesh; places are in its coordinates
  float deviation = 0;  ///< Hausdorff distance from the original, at most; 0: it is that
};

/// Collapses edges, those with the least quadric error first (Garland and Heckbert 1997, as in
/// CGAL), as long as no point of either surface is farther than max_deviation from the other. That
/// is measured, by surface_deviations() both ways; what the faces that are too far, or that cross
/// one another and did not before, have come from is kept as it is, and collapsing begins anew.
/// Where no few attempts suffice the mesh is returned as it is.
///
/// An oriented manifold stays one, with as many components and borders.
/// @param mesh           that require_bakeable() let pass
/// @param max_deviation  above 0 and at most kMostDeviation, for radius 1
/// Deterministic, whatever the number of threads. About 20 us a triangle and attempt, of which one
/// to five are made.
Reduced reduce(const NormalMesh& mesh, const CheckReport& check, double max_deviation,
               const Progress& progress);

}  // namespace palpate::bake

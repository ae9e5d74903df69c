// SPDX-License-Identifier: GPL-3.0-or-later
// Surface deviation s (Sec. 4.5): how far simplified patches are from the original surface.
#pragma once

#include <vector>

#include "host_bake/decompose/decompose.hpp"
#include "host_bake/mesh/mesh.hpp"
#include "host_bake/metrics/nearest.hpp"

namespace palpate::bake {

/// A surface deviation exceeds the true one by at most this share ...
inline constexpr double kDeviationExcess = 0.1;
/// ... or is at most this, for radius 1: what a dozen roundings of coordinates amount to.
inline constexpr double kDeviationTolerance = 1e-6;
/// ... unless a triangle has been cut more often than this.
inline constexpr std::size_t kMaxCuts = 4096;

/// Surface deviation s of every patch, for radius 1: no point of the patch's triangles is farther
/// than s from the original surface. The paper does not say how it measures s; this is the directed
/// Hausdorff distance, as an upper bound that holds for every point, not for samples of them.
///
/// How it is bounded: the distance to one original triangle is a convex function of the point, so
/// over a convex cell of a patch's triangle it is largest at a corner of the cell, and bounds the
/// distance to the surface there. That original triangle is the one nearest to the cell's centre or
/// to one of its corners, or a neighbour of such. From below the patch's s is bounded by distances
/// from corners and centres to the surface. Cells are cut, where possible along the side of their
/// original triangle (at which the nearest triangle changes), until both bounds of the patch meet
/// up to kDeviationExcess or kDeviationTolerance, or the cuts run out; the upper bound holds in any
/// case. It includes all roundings and is rounded up, so it is never 0, but about 1e-12 where
/// nothing has moved.
///
/// Parallel; the same whatever the number of threads. About 10 us a triangle over all levels of a
/// golf ball of 178,000; more on coarse levels, whose triangles cover many original ones.
/// @param level  vertices inside the unit ball (up to rounding), in the original's frame
std::vector<float> surface_deviations(const NearestSurface& original, const NormalMesh& level,
                                      const std::vector<Patch>& patches);

}  // namespace palpate::bake

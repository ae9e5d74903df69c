// SPDX-License-Identifier: GPL-3.0-or-later
// Tight bounds of what lies below a piece, so that the engine need not pay for the drift of patches
// through eq. 5.
#pragma once

#include <cstdint>
#include <vector>

#include "host_bake/hierarchy/hierarchy.hpp"

namespace palpate::bake {

/// A hull that holds every descendant of level 0, but for `residual`.
struct CullingBound {
  std::vector<std::uint32_t> points;  ///< into Hierarchy::points; empty: the piece's own hull
  float residual = 0;  ///< no point of a descendant is farther outside, for radius 1, rounded up
};

/// Of every piece. Up to image::kMaxCullingVertices extreme points of the descendants are taken as
/// they are; from more, those that are extreme along directions spread evenly once the points'
/// covariance is made a sphere (patches are flat: even directions would pick from their borders
/// alone), and the residual is measured against all of them. Where the piece's own hull with h is
/// no worse, it serves. Parallel; the same whatever the number of threads.
/// @param hausdorff  of each piece (hausdorff_bounds())
std::vector<CullingBound> culling_bounds(const Hierarchy& tree,
                                         const std::vector<float>& hausdorff);

}  // namespace palpate::bake

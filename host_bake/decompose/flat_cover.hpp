// SPDX-License-Identifier: GPL-3.0-or-later
// Does a flat set of faces fill its own hull?
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/decompose/surface_edges.hpp"

namespace palpate::bake {

/// How far below its surface the interior of a hull begins, relative to the object's radius. It is
/// above the rounding of the vertices (6e-8) and a twentieth of what a distance may be wrong by.
inline constexpr double kShrink_rel = 1e-7;

/// Seen along their mean normal, the faces face the viewer, do not overlap, and fill a convex
/// polygon: no point of the polygon is farther than kShrink_rel from them. A ring about a pit does
/// not, nor does a bay in the border. `owner` holds an entry a face; the set is the faces owned by
/// `id`, and `faces` lists them. O(b e) for b border vertices and a polygon of e edges.
bool fills_convex_polygon(const NormalMesh& mesh, const SurfaceEdges& edges,
                          std::span<const std::uint32_t> faces,
                          std::span<const std::uint32_t> owner, std::uint32_t id);

}  // namespace palpate::bake

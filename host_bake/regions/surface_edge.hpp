// SPDX-License-Identifier: GPL-3.0-or-later
// How a surface bends across an edge.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/image/region_format.hpp"

namespace palpate::bake {

enum class Bend : std::uint8_t { flat, convex, concave };

/// Flat, too: at a border, and beside a sliver, which has no normal.
/// @param side  3 * triangle + i, from corner i to i + 1
/// O(1)
Bend bend_of(std::span<const image::RegionTriangle> triangles, std::uint32_t side);

}  // namespace palpate::bake

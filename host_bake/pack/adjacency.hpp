// SPDX-License-Identifier: GPL-3.0-or-later
// Which hull vertices are joined by a hull edge: what hill climbing walks on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::bake {

struct Adjacency {
  std::vector<std::uint32_t> starts;      ///< [vertices + 1] into neighbours, the first 0
  std::vector<std::uint32_t> neighbours;  ///< each list strictly ascending
};

/// From the edges of a hull's triangles. Where more than three points share a facet, the diagonals
/// that divide it count as edges too. O(n log n).
Adjacency adjacency(std::span<const std::array<std::uint32_t, 3>> faces, std::uint32_t vertices);

}  // namespace palpate::bake

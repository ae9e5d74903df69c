// SPDX-License-Identifier: Apache-2.0
// Which of the regions that have entered the same piece tell the way out of it.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/palpate_rt.hpp"

namespace palpate::regions {

/// A contact of triangles that cross.
struct WayOut {
  double length = 0;  ///< how far its pieces have to move its way until they part; > 0
  std::uint32_t contact = 0;
};

/// Two convex pieces need only be moved the shortest way to part, but each region tells the way
/// that its own part of the curve leads: a side of a box that an edge has entered from below tells
/// one that is as long as the box. So of the contacts of the same two pieces each has its share
/// multiplied by the shortest of their ways over its own.
/// @param ways  in any order; scratch afterwards
/// O(n log n)
void share_by_ways_out(std::span<WayOut> ways, std::span<Contact> contacts) noexcept;

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
// Which of the regions that have entered the same piece tell the way out of it.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/palpate_rt.hpp"

namespace palpate::regions {

/// How far two pieces that cross in a region have to move the way of its contact until they part.
struct WayOut {
  double length = 0;  ///< any unit, > 0
  double part = 0;    ///< of the contact's depth
  std::uint32_t contact = 0;
  std::uint32_t piece_a = 0;
  std::uint32_t piece_b = 0;
};

/// Two convex pieces need only be moved the shortest way to part, but each region tells the way
/// that its own part of the curve leads: a side of a box that an edge has entered from below tells
/// one that is as long as the box. So of all contacts in which two pieces cross each has its share
/// lessened, to the shortest of their ways over its own. But moved that way they part as well when
/// they have come as far as another way is long along that one: its own counts as no longer than
/// any of the sixteen shortest ones over the cosine between the two. Where several pieces have a
/// part in a contact's depth, to the mean. Continuous where one way takes the place of another.
/// @param ways  in any order; scratch afterwards
/// O(n log n)
void share_by_ways_out(std::span<WayOut> ways, std::span<Contact> contacts) noexcept;

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
// Where two bodies have touched of late: measured again where a budget does not do for all that is
// near.
#pragma once

#include <cstddef>

#include "rt_core/levels/work.hpp"

namespace palpate::levels {

/// Exact queries with a budget do. Where simplified pieces are the answer, of a level that the
/// settings choose, what others gave would not last.
[[nodiscard]] inline bool remembers(const Work& work) noexcept {
  return work.rules.exact && work.meter.limited();
}

/// Notes that the pieces of a node give the contact that it keeps: in place of the last one there
/// (QueryMemory::touches), so that what is remembered lies all over the surface. O(levels)
void remember(Work& work, const Node& node) noexcept;

/// Measures pairs of pieces again that have touched, one query each, those first whose points of
/// then are nearest to each other now. A contact is kept by the front node that holds the pieces,
/// unless it keeps a nearer one: as any contact it bounds the distance from above and proves
/// nothing, so that what is remembered changes what is felt and never what is certified.
///
/// Departure: the paper's front is all that is known from tick to tick. Cut to what a small budget
/// measures, it holds some places of touch and loses all others; and bodies that slide on, or come
/// back after a leap, touch where they have touched before.
/// @param pair    number of the pair of bodies
/// @param enough  the budget does for all that is near: nothing is measured where a contact is kept
/// @return whether a contact is kept
/// Cost: up to half of the units that are left and at most kMostRecalled; where a contact is kept,
/// only of pairs whose points are within delta. O(front + kTouches)
bool recall(Work& work, std::size_t pair, bool enough) noexcept;

/// Queries of one pair of bodies in a tick.
inline constexpr std::uint64_t kMostRecalled = 64;

}  // namespace palpate::levels

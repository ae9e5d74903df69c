// SPDX-License-Identifier: Apache-2.0
// LOD interpolation (Sec. 5.5): no jump of the force where refinement moves up or down a level.
#pragma once

#include <cstdint>

#include "rt_core/levels/work.hpp"

namespace palpate::levels {

/// From this excess of a parent on, its children have all of the contact.
inline constexpr double kOwnContactFrom = 2;

/// Mixes the contacts of front nodes with that of their parent.
///
/// The paper gives no formula. Let e be how far a node's missing detail is above what the rules
/// allow (Detail::excess, 1 at the switch). Where a parent has e_p > 1 and all its near children
/// stopped, the largest of all its children's being e_c <= 1, they have the share
/// (e_p - 1) / (1 - e_c), at most all, of distance, normal and points, and the parent has the rest.
/// At e_p = 1, where refinement would stop at the parent, that is the parent's contact alone; at
/// e_c = 1, where a child would be refined, the children's alone: continuous at both, and where a
/// child comes within delta or leaves it. Where kappa asks for the children e_p is infinite and
/// they have all: it allows a piece or does not, however the bodies lie, so that no motion leads
/// from the one to the other, and a share of the parent would stay. The parents are what the query
/// has passed through, so the paper's conservative refinement below a stop is not needed. A parent
/// with e_p <= 1 takes its children's place: so the front does not depend on how it came about.
/// Only a parent that is within delta and yet has no contact, because its witness lies inside the
/// solid, leaves those of its children alone. One query for each near parent of settled children
/// that has a stopped one, or e_p < kOwnContactFrom, while the budget lasts; nothing else of the
/// front is looked at.
void interpolate(Work& work) noexcept;

/// Whether a node may ever have a share of its children's contacts. Free pieces have no metric, and
/// those that are too coarse for kappa have none.
[[nodiscard]] bool may_mix(const Work& work, const Node& node) noexcept;

/// Keeps a node inside the tree at hand for later ticks where its e_p < kOwnContactFrom.
void note_blending(Work& work, std::uint32_t index) noexcept;

}  // namespace palpate::levels

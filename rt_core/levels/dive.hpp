// SPDX-License-Identifier: Apache-2.0
// The dive: from simplified pieces down to the original surfaces, for the one contact that counts.
#pragma once

#include <cstdint>

#include "rt_core/levels/work.hpp"

namespace palpate::levels {

// Shares of delta.
/// What is searched for is known to this much: nothing below the node is nearer by more.
inline constexpr double kDiveTight = 0.05;
/// While nothing below can be nearer by more than this, the contact found before will do.
inline constexpr double kDiveLoose = 0.1;

/// Queries of one search, at most; beyond, and beyond kMaxOpenPairs, the nearest contact found
/// stands and nothing is proved.
inline constexpr std::uint64_t kMaxDiveQueries = 512;

/// Gives stopped nodes of simplified pieces the nearest contact of the original pieces below them,
/// and reports it.
///
/// Departure (Rules::contact_dive; the paper takes the distance of the simplified hulls, which
/// stand off the original surface by their deviation, often as much as delta): the front says where
/// contacts are and how many, the original surface how near. So the force hardly depends on the
/// level. First every node gets a contact: the two original pieces of the last tick, measured
/// again, or those that a search finds: depth first, nearest child next, with bounds of culling
/// hulls. Then nodes search again wherever what is proved (Node::certain) leaves more than
/// kDiveLoose: a search holds while the bodies move by less than that. What it proves is in the
/// certificate. In images without their finest levels the finest pieces stand for the original.
///
/// Where refinement was cut short nodes that still wait get their contacts so too. Where the budget
/// ends the last contact stands, or that of the simplified pieces. Cost: one query a node while the
/// motion is small, else a search; the budget.
void dive(Work& work) noexcept;

/// Stopped nodes that the budget did not do for report the contact that they keep.
void report_undived(Work& work) noexcept;

/// What a parent knows from the children that have dived: the nearest of their contacts, and what
/// all of them are certain of.
void gather(Work& work, std::uint32_t parent) noexcept;

}  // namespace palpate::levels

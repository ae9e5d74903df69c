// SPDX-License-Identifier: GPL-3.0-or-later
// The free levels: merging of hulls up to one root (Sec. 4.4, last step of Algorithm 0.1).
#pragma once

#include "host_bake/base/error.hpp"
#include "host_bake/hierarchy/hierarchy.hpp"

namespace palpate::bake {

/// Puts free levels on top of the pieces that have no parent, until one root is left. Each level
/// unites pieces in pairs (pair_up()), so many times, before their hulls are made; a piece without
/// a partner lives on unchanged, so that every merged piece has two children or more. The hull of a
/// merged piece is the hull of its children's enclosing points, the same floats: it encloses all
/// descendants of level 0 exactly. Departure: the paper merges the hulls of the simplified pieces
/// and widens them by h; free levels have no metric and give no contacts, so nothing is lost by
/// culling tightly.
///
/// @param rounds  1 to 12. 1: pairs, and a level each time the pieces have about halved. More make
/// fewer levels, with up to 2^rounds children a piece; so many or fewer are united to the root
///
/// The same result whatever the number of threads. Throws InputRefused where the levels pass
/// image::kMaxLevels. O(n log n) expected, n = vertices of the hulls over all levels. Stage
/// "merge".
void merge_to_root(Hierarchy& tree, const Progress& progress, int rounds = 1);

}  // namespace palpate::bake

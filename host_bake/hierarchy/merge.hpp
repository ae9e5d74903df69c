// SPDX-License-Identifier: GPL-3.0-or-later
// The free levels: pairwise merging of hulls up to one root (Sec. 4.4, last step of Algorithm 0.1).
#pragma once

#include "host_bake/base/error.hpp"
#include "host_bake/hierarchy/hierarchy.hpp"

namespace palpate::bake {

/// Puts free levels on top of the pieces that have no parent, until one root is left. Each level
/// merges pairs (pair_up()), so it has about half as many pieces; a piece without a partner lives
/// on unchanged, so that every merged piece has two children. The hull of a merged piece is the
/// hull of its children's enclosing points, the same floats: it encloses all descendants of level 0
/// exactly. Departure: the paper merges the hulls of the simplified pieces and widens them by h;
/// free levels have no metric and give no contacts, so nothing is lost by culling tightly.
///
/// The same result whatever the number of threads. Throws InputRefused where the levels pass
/// image::kMaxLevels. O(n log n) expected, n = vertices of the hulls over all levels. Stage
/// "merge".
void merge_to_root(Hierarchy& tree, const Progress& progress);

}  // namespace palpate::bake

// SPDX-License-Identifier: Apache-2.0
// Which contacts a force owes most to, for what little they have beside them.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Measures which way the witnesses of felt regions lie, and tells how alone each one is there
/// (Active::lone): of those that push in nearly one direction the force feels one
/// (force/penalty.hpp), so that an error of one among fifty is hardly felt, and of one that is
/// alone, all of it. Directions are those in which first bodies are pushed, whichever is the tool.
/// Nothing where the budget ends before that. Does not change widths and urgencies.
/// Cost: kBatchUnits for sixteen felt regions of one pair of bodies, plus O(active)
void tell_lone(Work& work) noexcept;

}  // namespace palpate::regions

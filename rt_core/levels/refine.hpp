// SPDX-License-Identifier: Apache-2.0
// Sensation preserving refinement: from the front of the last tick to that of this one.
#pragma once

#include "rt_core/levels/work.hpp"

namespace palpate::levels {

/// Works the queue off while the budget lasts.
///
/// Near front nodes are measured first, nearest first: at delta or more they are left alone; where
/// missing detail could be felt (rules.hpp), or what there is of it hides a contact that could be
/// (LeafContact::hidden_a), they wait to be split, in the order of Rules::order over all pairs of
/// bodies (start.hpp); else they stop and give a contact. In an exact query that
/// may end (Work::may_end) all detail is missing: contacts of simplified pieces stand in until it
/// is there. A split replaces a node by all pairs of one piece's children, which are measured
/// before the next split. What is still on the queue afterwards is not resolved.
void refine(Work& work) noexcept;

}  // namespace palpate::levels

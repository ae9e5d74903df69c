// SPDX-License-Identifier: Apache-2.0
// What a query found, as contacts.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Appends a contact to work.memory.contacts for every active region whose witness, measured at the
/// present poses, is nearer than delta: closest points and normal, or depth and direction of
/// overlap where its triangles cross. A region that has passed through a face without crossing it
/// any more is as deep as it is far from that face. So is a component that is deep inside the other
/// body (Containment::leaving), which has a contact of its own.
///
/// Witnesses are placed in double and compared relative to the pair, sixteen at a time. Cost:
/// O(active), for every crossing region what find_crossings() and overlap() take, and a look
/// through at most 64 nodes, which no budget counts, for one that seems to have passed through
/// while its interval is open.
void report(Work& work) noexcept;

}  // namespace palpate::regions

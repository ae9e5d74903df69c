// SPDX-License-Identifier: Apache-2.0
// What a query found, as contacts.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Appends a contact to work.memory.contacts for every active region whose witness, measured at the
/// present poses, is nearer than delta: closest points, normal, and their distance, negative where
/// that of a is inside b, 0 where the triangles cross.
///
/// Witnesses are placed in double and compared relative to the pair, sixteen at a time. O(active)
void report(Work& work) noexcept;

}  // namespace palpate::regions

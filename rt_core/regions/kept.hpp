// SPDX-License-Identifier: Apache-2.0
// The pairs of triangles that are kept of regions, at the present poses.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Measures those of the kept pairs that may be nearer than their region's witness now, which they
/// replace where they are. That they are not is known of most: by how far they were apart and how
/// the bodies have moved since; and along the way from the witness's one point to the other, where
/// triangles that share its corner or its edge are as far apart as it and no nearer.
///
/// Where the budget ends this, they count as not kept.
/// Precondition: witnesses are measured. Cost: at most half of a budget; kBatchUnits for sixteen
/// pairs that are measured, kSeparationUnits for sixteen that are looked at along a way
void measure_kept(Work& work) noexcept;

}  // namespace palpate::regions

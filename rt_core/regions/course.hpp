// SPDX-License-Identifier: Apache-2.0
// Which way a region is going.
//
// Bodies that touch slide along each other farther than they move apart or together, and a step is
// much like the one before. A proof for one place would be worth the less the farther a region
// goes, whichever way; one for all places on its way lasts while the region keeps to it, and what
// the region only passes by does not count (swept volumes; Redon, Kheddar and Coquillart 2002 bound
// boxes so between two poses, to find a first contact).
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// A course that a region is about to go.
struct Course {
  Vec3d way{};     ///< of its centre, in the coordinates of b, from the present place
  float away = 0;  ///< how far that takes the region from its witness, in units
};

/// For the ticks to come; O(1). None where bodies are too fast, stand still, or
/// have just jumped, or where nothing that is kept of the region would last. What brings a region
/// nearer to its witness is left out: while that comes nearer no less than anything else, the
/// interval between them grows no wider.
[[nodiscard]] Course course_ahead(const Work& work, const Active& item) noexcept;

}  // namespace palpate::regions

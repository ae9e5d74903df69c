// SPDX-License-Identifier: GPL-3.0-or-later
// The finished hierarchy as bytes: rt_core/image/format.hpp, docs/FORMAT.md.
#pragma once

#include <cstddef>
#include <vector>

#include "host_bake/hierarchy/hierarchy.hpp"
#include "host_bake/metrics/metrics.hpp"
#include "host_bake/regions/region_tree.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {

/// Lays out the image.
///
/// @param tree     merged to one root
/// @param metrics  of that tree
/// @param facts    a header with what is known about the source and the bake: flags, source_*,
/// centre_m, radius_m, delta_rel,
///                 stop_*, s0_min, partner_area; everything else is filled in here
/// @param regions  of the mesh that the tree's level 0 is of, or empty: no sections for the region
/// engine
/// @return the whole image. The bytes depend on the arguments only: padding and reserved fields are
/// zero. Throws InputRefused where a limit of the format is passed, naming it. O(size of the
/// image).
std::vector<std::byte> pack(const Hierarchy& tree, const Metrics& metrics,
                            const image::Header& facts, const RegionTree& regions = {});

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
// A grown patch in the form that decompose() returns.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/decompose/decompose.hpp"
#include "host_bake/decompose/plates.hpp"
#include "host_bake/hull/growing_hull.hpp"

namespace palpate::bake {

/// hull: of the patch where it is solid; else not looked at, the one plate's corners are the hull.
/// A facet counts as covered where the plates in its plane have its area (to 1e-9 of it); else all
/// its triangles are virtual. O(n log n).
Patch make_patch(const NormalMesh& mesh, const Plates& plates,
                 std::span<const std::uint32_t> members, const GrowingHull* hull, bool back_open);

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
// Only what a scene requires: the finest levels left out.
#pragma once

#include <cstdint>
#include <optional>

#include "host_bake/hierarchy/hierarchy.hpp"
#include "host_bake/metrics/metrics.hpp"

namespace palpate::bake {

/// The least threshold s0 (relative to the radius) that an image serves without its `dropped`
/// finest levels, against partners whose support areas are at least `partner_area` (relative to the
/// radius squared): with it, no piece of the finest level kept is ever refined (eq. 7 with the
/// least D of the piece's vertices), unless hulls overlap: then the finest level kept has to stand
/// for the original surface. Empty where that level is not a simplified one. Above 0; 0 for dropped
/// = 0. O(pieces).
std::optional<float> served_s0(const Hierarchy& tree, const Metrics& metrics, std::uint32_t dropped,
                               float partner_area);

/// Leaves the finest `dropped` levels out: the pieces of the first level kept become leaves. Their
/// metrics go on to be those against the original surface.
/// @pre served_s0() gives a value for `dropped`
void drop_levels(Hierarchy& tree, Metrics& metrics, std::uint32_t dropped);

}  // namespace palpate::bake

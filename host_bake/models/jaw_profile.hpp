// SPDX-License-Identifier: GPL-3.0-or-later
// Heights of two dental arches in bite over the band along the arch. All lengths in millimetres.
#pragma once

#include <cstdint>

namespace palpate::bake {

enum class Jaw { lower, upper };

/// A place on the band: s along the arch from the midline (negative: right side), t across it,
/// outwards.
struct BandPlace {
  double s_mm, t_mm;
};

/// Half the length and half the width of the band.
inline constexpr double kArchHalf_mm = 61.0;
inline constexpr double kBandHalf_mm = 8.5;

/// The biting surface of a jaw, as z over the band: crowns with the midline between the first
/// incisors, gums around them. The jaws keep to either side of one common surface, half a clearance
/// away from it or more, measured across the surface: lower_z < upper_z everywhere. Where crowns
/// meet crowns they follow it: an overbite in front, where the lower edges stand behind the upper
/// ones, and cusps in fossae behind. Tooth widths after Wheeler's Dental Anatomy (Nelson, Ash),
/// table of average crown dimensions, rounded.
double biting_z_mm(Jaw jaw, BandPlace at, std::uint64_t seed);

}  // namespace palpate::bake

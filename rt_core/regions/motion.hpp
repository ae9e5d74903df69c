// SPDX-License-Identifier: Apache-2.0
// How fast bodies move, and so how far ahead a search looks.
#pragma once

#include "rt_core/levels/body_pair.hpp"

namespace palpate::regions {

/// Of any point of a in the last tick, at most, in units.
inline double last_motion(const levels::PairState& pair) noexcept {
  return pair.last_travel + pair.last_turn * pair.scale_a;
}

/// Pairs that are farther than the nearest by less than this, in units, are kept, and so the region
/// needs no search until it is so far off its course (close.cpp): by four ticks of the present
/// motion, but at most by a share of delta, for what is farther costs more than the rest saves; and
/// not at all where that is no more than three ticks.
inline double margin_of(const levels::PairState& pair) noexcept {
  constexpr double kRestTicks = 4;
  constexpr double kFewestTicks = 3;
  constexpr double kMostRest = 0.4;
  constexpr double kLeastRest = 0.01;
  const double tick = last_motion(pair);
  const double most = kMostRest * pair.delta;
  if (kFewestTicks * tick > most) return 0;
  const double wanted = kRestTicks * tick;
  const double least = kLeastRest * pair.delta;
  return wanted > most ? most : wanted > least ? wanted : least;
}

}  // namespace palpate::regions

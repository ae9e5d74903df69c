// SPDX-License-Identifier: Apache-2.0
// What searching and following have brought of late: which of them witnesses come nearer by.
#pragma once

#include <cstdint>

namespace palpate::regions {

/// How much nearer witnesses have come, and for how much work; both fade.
struct Yield {
  double gain = 0;   ///< sum over regions, in contact tolerances
  double units = 0;  ///< work units
  void add(double more_gain, double more_units) noexcept {
    gain += more_gain;
    units += more_units;
  }
  void fade() noexcept {
    constexpr double kKept = 0.875;  // a tick: what counts is the last eight or so
    gain *= kKept;
    units *= kKept;
  }
};

/// Of an engine, from tick to tick.
struct Pursuit {
  Yield search;
  Yield follow;
  double search_units = 0;       ///< what a search takes, of late
  std::uint32_t searches = 0;    ///< of which that is the mean, at most kMostSearches
  bool lagged = false;           ///< searches did not keep up with the last tick
  double surveyed = 1;           ///< which part of all regions has been, since the last jump
  std::uint32_t round = 0;       ///< ticks in which witnesses were followed
  std::uint32_t next_dive = 0;   ///< where the next one begins to dive
  std::uint32_t next_look = 0;   ///< where the next watch (watch.hpp) begins to look ...
  std::uint32_t next_climb = 0;  ///< ... and to climb
  std::uint64_t unit_ns = 0;     ///< time of a work unit; 0: not known
  std::uint64_t survey_ns = 0;   ///< the same of surveys: many looks in a row take less
  double listing_units = 64;     ///< what the pairs that cross in a region take to list, of late;
                                 ///< first, what does for half of them

  /// @param units     that it took to list the pairs that cross in a region
  /// @param complete  false: it would have taken more
  void learn_listing(double units, bool complete) noexcept {
    constexpr double kFollowed = 0.125;  // within some eight of them
    constexpr double kMost = 4096;
    const double taken = complete ? units : units + listing_units;
    listing_units += kFollowed * ((taken < kMost ? taken : kMost) - listing_units);
  }

  void learn_search(double units) noexcept {
    constexpr std::uint32_t kMostSearches = 16;
    if (searches < kMostSearches) ++searches;
    search_units += (units - search_units) / static_cast<double>(searches);
  }
};

}  // namespace palpate::regions

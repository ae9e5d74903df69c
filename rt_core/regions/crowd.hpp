// SPDX-License-Identifier: Apache-2.0
// Which regions are followed and felt where more are near than a tick has time for.
#pragma once

#include <cstdint>
#include <span>

namespace palpate::regions {

struct Active;
struct QueryMemory;
struct Work;

/// Who is felt, from tick to tick.
struct Crowd {
  static constexpr std::uint32_t kAll = 16;

  std::uint32_t share = kAll;  ///< of sixteen regions in a row so many are, at least one
  bool thinned = false;        ///< not all are, or not wholly
  std::uint32_t felt = 0;      ///< where thinned: how many are, those that cross not counted
  std::span<float> absence;    ///< [states] how much of each is not: 0 to 1

  [[nodiscard]] double presence(std::uint32_t state) const noexcept {
    return 1 - static_cast<double>(absence[state]);
  }
  [[nodiscard]] bool has(std::uint32_t state) const noexcept { return absence[state] < 1; }

  /// All are felt, at once.
  void gather_all() noexcept {
    if (!thinned) return;
    for (float& a : absence) a = 0;
    share = kAll;
    felt = 0;
    thinned = false;
  }
};

/// Thins out the regions that are felt where they are more than `most`, evenly over the surface:
/// what is left tells much the same force, for that is felt once in each direction however many
/// tell it (force/penalty.hpp), and each gets more of the tick's work. Regions are numbered
/// depth first, so that those in a row are neighbours: of sixteen at least one stays, so that no
/// place is lost, and all that cross the other body.
///
/// Who stays or goes does so by a sixteenth a tick, so that forces come and go smoothly; where half
/// as many again as `most` are felt they go by a quarter, and so comes what crosses. What is not
/// felt yet is wholly there, but beside one that is felt and stays, where it would have to go
/// again.
/// @param most  regions, those that cross not counted; infinity: all there are
/// O(active)
void thin_out(QueryMemory& memory, std::span<const Active> active, double most) noexcept;

/// To what the time after the searches does for, of which what crosses takes half at most; a few
/// regions are never thinned out. Where searches do not keep up, many are to fewer than that. After
/// a jump nobody knows yet who is felt, and all are.
void thin_out(Work& work) noexcept;

}  // namespace palpate::regions

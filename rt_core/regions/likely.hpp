// SPDX-License-Identifier: Apache-2.0
// Contacts that vertices are likely to have: where each is by the triangle that the other body's
// proximity grid names there. Nothing is proved: a search measures those first that may change the
// push most.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/force/least_push.hpp"
#include "rt_core/regions/side_view.hpp"

namespace palpate::regions {

/// Of a vertex, as a constraint of the push.
struct LikelyContact {
  Vec3f push{};          ///< direction in which it pushes the tool, unit, world axes
  float strength_m = 0;  ///< weight times what is short of delta, > 0
  float weight = 0;      ///< (0, 1]
  std::uint32_t side = 0;
  std::uint32_t vertex = 0;
};

/// What is kept of one side from tick to tick: up to which odometer a region or a vertex need not
/// be looked at again. One that is out of reach rests until the bodies have moved by what it is
/// beyond; one that the push exceeds, until motion and changes of the push have used that up.
struct LikelyMemory {
  std::span<double> regions;
  std::span<double> vertices;
};

/// The push of the tick before, and how much it has changed in all ticks so far; metres.
struct PushSoFar {
  force::Push push;
  double changed_m = 0;
};

/// Looks at the regions of one side.
class LikelyContacts {
 public:
  LikelyContacts(const SideView& view, std::uint32_t side, const LikelyMemory& memory,
                 const PushSoFar& push) noexcept;

  /// Appends those of a region's vertices.
  /// @param count  how many of `out` are in use; grows up to its size
  /// @return how many vertices were looked at
  /// Cost: for each of them a read of the grid and of a triangle.
  std::uint32_t look(std::uint32_t region, std::span<LikelyContact> out,
                     std::uint32_t& count) noexcept;

 private:
  [[nodiscard]] double distance_of_centre(std::uint32_t region) const noexcept;
  /// @return the likely distance, in units of the pair; strength 0 where it is no contact
  double look_at(std::uint32_t vertex, LikelyContact& out) const noexcept;
  /// How long a vertex rests, in units of the pair.
  [[nodiscard]] double rest_of(double distance, const LikelyContact& contact) const noexcept;

  const SideView& view_;
  const contact::Surface& target_;
  LikelyMemory memory_;
  const PushSoFar& push_;
  std::uint32_t side_;
  double odometer_;
  Mat3f turn_;   ///< P to Q
  Vec3f move_;   ///< likewise, in Q's image coordinates
  float scale_;  ///< of P's image coordinates in those of Q's
};

}  // namespace palpate::regions

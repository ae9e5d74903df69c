// SPDX-License-Identifier: Apache-2.0
// Contacts that vertices are likely to have: where each is by the triangle that the other body's
// proximity grid names there, or by the neighbour beyond its nearest edge. Nothing is proved: a
// search measures those first that may change the push most.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/force/least_push.hpp"
#include "rt_core/regions/side_view.hpp"

namespace palpate::regions {

/// Where a contact comes from: a vertex of the side's points, or an edge (its index in
/// surface_edges, plus kEdge).
struct ContactSource {
  static constexpr std::uint32_t kEdge = 0x80000000u;
  std::uint32_t side = 0;
  std::uint32_t item = 0;
  [[nodiscard]] bool is_edge() const noexcept { return (item & kEdge) != 0; }
  [[nodiscard]] std::uint32_t index() const noexcept { return item & ~kEdge; }
  bool operator==(const ContactSource&) const = default;
};

/// As a constraint of the push.
struct LikelyContact {
  Vec3f push{};          ///< direction in which it pushes the tool, unit, world axes
  float strength_m = 0;  ///< weight times what is short of delta, > 0
  float weight = 0;      ///< (0, 1]
  ContactSource source;
};

/// What is kept of a region's likely contacts from tick to tick.
struct LikelyRegion {
  double until = 0;                   ///< up to this odometer no vertex is due to be looked at
  double promise = 0;                 ///< when last looked at: the largest strength, or less than
                                      ///< 0: what the nearest vertex is beyond delta; in units
  double promised_at = kNeverLooked;  ///< odometer then

  static constexpr double kNeverLooked = -1;
  [[nodiscard]] bool never_looked() const noexcept { return promised_at < 0; }
};

/// What is kept of one side from tick to tick. A vertex rests up to an odometer: one that is out of
/// reach until the bodies have moved by what it is beyond; one that is too weak to count, until
/// motion and changes of the push have used up what it is short of that.
struct LikelyMemory {
  std::span<LikelyRegion> regions;
  std::span<double> vertices;
};

/// The push of the tick before, and by how much that in any direction may have changed in all ticks
/// so far; metres.
struct PushSoFar {
  force::Push push;
  double changed_m = 0;
};

/// Looks at the regions of one side.
class LikelyContacts {
 public:
  LikelyContacts(const SideView& view, std::uint32_t side, LikelyMemory& memory,
                 const PushSoFar& push) noexcept;

  [[nodiscard]] bool is_due(std::uint32_t region) const noexcept {
    return !(memory_.regions[region].until > odometer_);
  }
  /// The larger, the sooner it should be looked at: what it promised, and half of the motion since.
  [[nodiscard]] double promise(std::uint32_t region) const noexcept;
  /// Of a region that has never been looked at, by a bound of its distance (in units).
  void promise_by_distance(std::uint32_t region, double lower, double radius) noexcept;

  /// Appends those of a region's vertices.
  /// @param count  how many of `out` are in use; grows up to its size
  /// @return how many vertices were looked at
  /// Cost: for each of them a read of the grid and of at most two triangles.
  std::uint32_t look(std::uint32_t region, std::span<LikelyContact> out,
                     std::uint32_t& count) noexcept;

 private:
  /// Where the image of P is in the coordinates of Q's.
  struct Placement {
    Mat3f turn{};
    Vec3f move{};
    float scale = 1;

    [[nodiscard]] Vec3f operator()(Vec3f x) const noexcept { return turn * (scale * x) + move; }
  };
  [[nodiscard]] Placement placement() const noexcept;
  /// @param out  strength 0 where it is no contact
  /// @return its likely signed distance, in units of the pair
  double look_at(const Placement& placed, std::uint32_t vertex, LikelyContact& out) const noexcept;
  /// How long a vertex rests, in units of the pair.
  [[nodiscard]] double rest_of(double distance, const LikelyContact& contact) const noexcept;

  const SideView& view_;
  const contact::Surface& target_;
  LikelyMemory& memory_;
  const PushSoFar& push_;
  std::uint32_t side_;
  double odometer_;
};

}  // namespace palpate::regions

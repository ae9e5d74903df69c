// SPDX-License-Identifier: Apache-2.0
// Contacts at one place count as one: masses that do not depend on how finely a surface is cut.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::force {

/// One corner of a cubic grid, where contacts have come near it in this tick.
struct Place {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint32_t tick = 0;  ///< when it was last in use
  double most = 0;         ///< largest mass brought by one contact
  double sum = 0;          ///< of all masses brought
};

/// Where a contact has brought its mass: the corners of its tetrahedron, a sixth of a cube.
struct Spot {
  static constexpr std::size_t kCorners = 4;
  static constexpr std::uint32_t kNone = UINT32_MAX;  ///< no room was found, or none is needed

  std::array<double, kCorners> share{1, 0, 0, 0};                         ///< add up to 1
  std::array<std::uint32_t, kCorners> place{kNone, kNone, kNone, kNone};  ///< in the table
};

/// A grid that remembers only the corners that contacts come near: a hash table over borrowed
/// memory, emptied in O(1).
///
/// A contact brings its mass to the four corners of its tetrahedron (Kuhn), in linear shares. A
/// corner counts as much as the largest mass brought, and hands that out in proportion. So a
/// contact alone keeps its mass wherever it lies, coincident ones have that of one together, a wide
/// contact gets a mass that grows with its area and not with its triangles, and everything is
/// continuous in the points and masses and independent of their order but for rounding: of the
/// shares themselves too, for those below 1e-9 are kept and take no room.
class Places {
 public:
  /// Places of a table in which so many contacts find theirs at once: two for each corner.
  static constexpr std::size_t room_for(std::size_t contacts) noexcept {
    return 2 * Spot::kCorners * contacts;
  }

  Places() = default;
  /// @param table  less than Spot::kNone; twice as many as corners in use are found at once
  explicit Places(std::span<Place> table) noexcept : table_(table) {}

  /// Tells where the table is now: its values stay.
  void attach(std::span<Place> table) noexcept { table_ = table; }

  /// Begins a tick with another grid.
  /// @param width_m   of a cube; 0: every contact keeps its mass
  /// @param contacts  as many will be brought, at most: few use a small part of the table, which
  ///                  stays in the cache
  void begin(double width_m, std::size_t contacts) noexcept;

  /// Brings a contact. O(1): at most 128 looks for each of four corners
  /// @param point_m  in the axes of the grid
  /// @param mass     of the contact, >= 0
  Spot add(Vec3d point_m, double mass) noexcept;

  /// What is handed out, after all have brought theirs, for a contact of this mass: at most that.
  /// O(1)
  [[nodiscard]] double share(const Spot& spot, double mass) const noexcept;

  /// Whether corners found no room since begin(): contacts there keep their mass.
  [[nodiscard]] bool full() const noexcept { return full_; }

 private:
  /// Index of the corner in the table, Spot::kNone where that is full.
  [[nodiscard]] std::uint32_t find(std::int32_t x, std::int32_t y, std::int32_t z) noexcept;

  std::span<Place> table_;
  std::size_t in_use_ = 0;  ///< of the table
  double per_m_ = 0;
  std::uint32_t tick_ = 0;
  bool full_ = false;
};

}  // namespace palpate::force

// SPDX-License-Identifier: Apache-2.0
// The largest depth felt in nearly a direction, over all contacts.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rt_core/base/queue.hpp"
#include "rt_core/force/places.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::force {

/// A contact as the force stage sees it.
struct Felt {
  Vec3d point_m{};     ///< between its points, from the tool's origin, world axes
  Vec3d direction{};   ///< unit: where it pushes the tool
  double depth_m = 0;  ///< below delta, as much of it as is felt; > 0
  double mass = 0;     ///< see penalty.hpp
  Spot spot;           ///< where it brought that
  std::uint32_t contact = 0;
  std::uint32_t side = 0;  ///< of a box, that the direction is nearest to
};

/// A contact waiting to be put in order.
struct Ranked {
  double depth_m = 0;
  std::uint32_t felt = 0;
};

struct Deeper {
  bool operator()(const Ranked& a, const Ranked& b) const noexcept {
    return a.depth_m > b.depth_m || (a.depth_m == b.depth_m && a.felt < b.felt);
  }
};

/// Contacts side by side, to be looked at at once.
struct DeepLanes {
  static constexpr std::uint32_t kLanes = 8;
  double x[kLanes];  ///< of their directions
  double y[kLanes];
  double z[kLanes];
  double depth_m[kLanes];  ///< 0 beyond the last contact
};

/// Scratch: the deepest contacts of each side of a box, by depth.
struct DeepSides {
  static constexpr std::uint32_t kSides = 6;
  /// Looks at contacts of one side, at most: the deepest ones. More are needed only where very many
  /// contacts push in directions that differ by more than 30 degrees within a side; contacts of one
  /// direction that follow one another in depth, as those of a flat face, count as the deepest.
  static constexpr std::uint32_t kMostLooks = 64;

  DeepLanes lanes[kSides][kMostLooks / DeepLanes::kLanes];
};

/// Contacts in the order of depth, apart for the six sides of a box that their directions are
/// nearest to, so that the largest of depth times kinship is found after a few looks.
class Depths {
 public:
  /// @param felt     outlives this
  /// @param ranking  scratch, [felt], outlives this
  /// @param sides    scratch, outlives this
  /// O(n)
  Depths(std::span<Felt> felt, std::span<Ranked> ranking, DeepSides& sides) noexcept;

  /// Largest depth_m * kinship over the contacts within 90 degrees of f's direction, f itself
  /// included. Continuous in all of them. Puts contacts in order as far as it looks. O(1), at most
  /// 6 kMostLooks looks, and O(n log n) for all contacts together
  [[nodiscard]] double around(const Felt& f) noexcept;

 private:
  /// Contacts of one side: the deepest are laid side by side, the others wait.
  struct Side {
    MinQueue<Ranked, Deeper> waiting{{}};
    std::uint32_t count = 0;  ///< laid
    Vec3d last{};             ///< direction of the last one laid
  };

  [[nodiscard]] double around(const Felt& f, std::uint32_t side, double most_m) noexcept;
  void lay(Side& of, DeepLanes& to) noexcept;

  std::span<const Felt> felt_;
  DeepSides& sides_;
  std::array<Side, DeepSides::kSides> of_side_;
};

}  // namespace palpate::force

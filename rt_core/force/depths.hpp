// SPDX-License-Identifier: Apache-2.0
// The largest depth felt in nearly a direction, over all contacts.
#pragma once

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
  std::uint32_t cell = 0;  ///< of directions, see Depths
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

/// Scratch: contacts by cells of directions. Of a cell the deepest are laid side by side and the
/// others wait.
struct DeepCells {
  /// Quarters of the faces of a cube: which coordinate is the largest, and the signs of all.
  static constexpr std::uint32_t kCells = 24;
  /// Looks at contacts of one cell, at most: the deepest ones. More are needed only where very many
  /// contacts push in directions that differ by more than 30 degrees within a cell; contacts of one
  /// direction that follow one another in depth, as those of a flat face, count as the deepest.
  static constexpr std::uint32_t kMostLooks = 32;
  /// Tangents to how much a cell's contacts may have in common with a direction.
  static constexpr std::uint32_t kTangents = 2;

  struct Cell {
    MinQueue<Ranked, Deeper> waiting{{}};
    std::uint32_t count = 0;  ///< laid
    Vec3d last{};             ///< direction of the last one laid
  };
  Cell cells[kCells];  ///< those that are not empty, from the first on
  DeepLanes lanes[kCells][kMostLooks / DeepLanes::kLanes];

  // Cells side by side. A direction whose cosine to the axis is c has one of no more than
  // min(1, rise + slope c) to any contact of the cell.
  float axis[3][kCells];  ///< about which all directions of the cell are
  float slope[kTangents][kCells];
  float rise[kTangents][kCells];
  float depth_m[kCells];  ///< the largest; 0 beyond the last cell
};

/// Contacts in the order of depth, apart for cells of nearly one direction, so that the largest of
/// depth times kinship is found after a few looks.
class Depths {
 public:
  /// @param felt     outlives this
  /// @param ranking  scratch, [felt], outlives this
  /// @param cells    scratch, outlives this
  /// O(n)
  Depths(std::span<Felt> felt, std::span<Ranked> ranking, DeepCells& cells) noexcept;

  /// Largest depth_m * kinship over the contacts within 90 degrees of f's direction, f itself
  /// included. Continuous in all of them. Puts contacts in order as far as it looks. O(1), at most
  /// kCells kMostLooks looks, and O(n log n) for all contacts together
  [[nodiscard]] double around(const Felt& f) noexcept;

 private:
  [[nodiscard]] double look_at(std::uint32_t cell, Vec3d direction, double most_m) noexcept;
  void lay(DeepCells::Cell& of, DeepLanes& to) noexcept;

  std::span<const Felt> felt_;
  DeepCells& cells_;
  std::uint32_t count_ = 0;  ///< of cells that are not empty
};

}  // namespace palpate::force

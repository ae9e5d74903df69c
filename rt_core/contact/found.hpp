// SPDX-License-Identifier: Apache-2.0
// Contacts of points and edges of one body with the surface of another (docs/CONTACT.md).
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/pace.hpp"
#include "rt_core/contact/nearby.hpp"

namespace palpate::contact {

/// The points of one body, P, and the surface of another, Q, that they may touch. Coordinates are
/// those of Q, in units of the pair, unless a name says otherwise.
struct Side {
  Surface points;    ///< P
  Target target;     ///< Q
  Mat3d rotation{};  ///< P to Q
  Vec3d translation{};

  [[nodiscard]] Vec3d to_target(Vec3d point) const noexcept {
    return rotation * point + translation;
  }
  [[nodiscard]] Vec3d to_points(Vec3d point) const noexcept {
    return transpose(rotation) * (point - translation);
  }
  [[nodiscard]] Vec3d turned_to_target(Vec3d v) const noexcept { return rotation * v; }
  [[nodiscard]] Vec3d turned_to_points(Vec3d v) const noexcept { return transpose(rotation) * v; }
};

/// A direction in which P is pushed, and how far it is from there.
struct FoundContact {
  Vec3d normal{};              ///< unit, from Q to P
  double distance = 0;         ///< d, signed: negative in overlap
  double weight = 0;           ///< w, (0, 1]
  Vec3d point{};               ///< on P
  Vec3d foot{};                ///< on Q
  std::uint32_t triangle = 0;  ///< of Q
};

/// What one point or edge gives, at most; the heaviest are kept.
inline constexpr std::uint32_t kMostFound = 64;

class FoundContacts {
 public:
  void clear() noexcept { count_ = 0; }
  /// Of equal normals and distances the heavier one is kept.
  void add(const FoundContact& contact) noexcept;
  [[nodiscard]] std::span<const FoundContact> all() const noexcept { return {contacts_, count_}; }

 private:
  FoundContact contacts_[kMostFound];
  std::uint32_t count_ = 0;
};

/// A direction in which a point leaves the target that it is inside of.
struct WayOut {
  Vec3d normal{};
  double strength =
      0;  ///< how far both surfaces face along it, less the farther away it ends, (0, 1]
};
/// Ways out of one point, at most; the strongest are kept.
inline constexpr std::uint32_t kMostWays = 256;

/// Triangles near one point that are kept for a second look; where there are more, the tree is
/// asked twice.
inline constexpr std::uint32_t kMostFeet = 256;

/// Working memory of one point or edge at a time, and what it has given.
struct Scratch {
  FoundContacts found;
  Foot feet[kMostFeet];
  WayOut ways[kMostWays];
};

/// All contacts of a vertex of P, in scratch.found.
/// @param hint   a triangle of Q that may be near it, or kNone
/// @param delta  contact tolerance, in units of the pair
/// @return the vertex's signed distance from Q
/// Cost: one traversal of Q's tree that meets all triangles within 1.8 delta, or three depths;
/// without a good hint, or where very many are near, another one before.
SignedDistance contacts_of_vertex(const Side& side, Pace& pace, std::uint32_t vertex,
                                  std::uint32_t hint, double delta, Scratch& scratch) noexcept;

/// Bounds from below of the signed distances of an edge's ends from Q, as lipschitz_bound() has
/// them; in units of the pair.
struct EdgeEnds {
  double from = 0;
  double to = 0;
};

/// All contacts of a convex edge of P with convex edges of Q, in scratch.found.
/// @param points  P as the target of queries
/// @param edge    its name (Edge)
/// @param delta   contact tolerance, in units of the pair
/// Cost: one traversal about the edge, and where something of it is inside another one, and two for
/// each edge of Q that it crosses in overlap.
void contacts_of_edge(const Side& side, const Target& points, Pace& pace, std::uint32_t edge,
                      const EdgeEnds& ends, double delta, Scratch& scratch) noexcept;

}  // namespace palpate::contact

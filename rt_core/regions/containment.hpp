// SPDX-License-Identifier: Apache-2.0
// Is one surface wholly inside another? Distances and crossings of triangles do not tell.
#pragma once

#include <cstdint>

#include "rt_core/levels/body_pair.hpp"
#include "rt_core/regions/search.hpp"

namespace palpate::regions {

struct Work;

enum class Side : std::uint8_t { unknown, outside, inside };

/// Nodes of one tree that are still to be visited; depth first.
struct Walk {
  std::uint32_t size = 1;  ///< of nodes; begins with the root
  std::uint32_t nodes[image::kMaxRegionDepth * image::kRegionWidth + 1] = {};
};

/// Directions that are tried, at most.
inline constexpr std::uint32_t kRayCount = 3;

/// A question for the side of a point, which is answered in as many ticks as it takes: in the
/// coordinates of the surface's image, where neither of them moves.
struct SideQuestion {
  Vec3d point{};
  std::uint32_t ray = 0;  ///< which direction is being tried
  int winding = 0;        ///< triangles passed outwards less those passed inwards
  Walk walk;
};

/// A component of one of a pair's bodies.
struct Component {
  bool of_b = false;
  std::uint32_t first = 0;  ///< triangle of it (component.hpp)
  bool operator==(const Component&) const = default;
};

/// So many components of a pair that are inside are felt, at most.
inline constexpr std::uint32_t kMostContained = kBatch;

/// A component that is inside the other body.
struct Contained {
  Component component;
  Witness nearest;    ///< if it is farther than delta from the surface: the nearest
  bool told = false;  ///< since it was last asked what is inside
};

/// What is kept of a pair from tick to tick.
struct Containment {
  std::uint32_t count = 0;  ///< of components that are inside
  Contained contained[kMostContained];
  std::uint32_t leaving = 0;  ///< bits of `contained`: in this tick their nearest are contacts
  bool doubtful = true;       ///< a jump, or surfaces that may have passed through each other since
  bool unseen = false;        ///< that they have is not ruled out: asked when nothing is felt
  bool crossed = false;       ///< in the tick before, what may have parted since
  bool suspected = false;     ///< it looks as if one were inside the other (scout.hpp)
  bool asked = false;         ///< `question` is open, of the bodies as they were when it was asked
  bool unanswered = false;    ///< of a component asked before no ray has told, or more are inside
  bool all_inside = false;    ///< all components asked before are
  Component asking;           ///< whether its first vertex is inside the other body
  SideQuestion question;      ///< until surfaces cross again its answer holds

  /// What is inside is as it was, and may be so no more, and others may be inside.
  [[nodiscard]] bool is_open() const noexcept { return doubtful || unseen || asked; }
  /// The same of one.
  [[nodiscard]] bool is_open(const Contained& one) const noexcept {
    return doubtful || unseen || (asked && !one.told);
  }
};

/// On which side of a closed surface a point lies: inside where a ray from it passes through more
/// triangles outwards than inwards. Shared edges are passed once, for both triangles see them in
/// the same numbers; a ray that meets an edge exactly is given up for another direction. A surface
/// that faces inwards, a room, has no inside. An open surface has no inside either.
/// @param question  as new, or as a call has left it that the pace ended
/// @return unknown where the pace ended it, or, with `ray` at kRayCount, all directions are used up
/// Cost: a unit for each node whose box the ray passes through, for at most three rays.
[[nodiscard]] Side side_of(const Kernels& kernels, const ImageView& body, SideQuestion& question,
                           Pace& pace) noexcept;

/// Whether a way meets no triangle of a surface. It may end on the surface, seen from inside:
/// within a thousandth of its end only triangles count through which it would go in, as those of a
/// wall without thickness. False too where the pace ends before that is known.
/// @param from, to  image coordinates of the body
/// Cost: a unit for each node whose box the way passes through.
[[nodiscard]] bool in_sight(const Kernels& kernels, const ImageView& body, Vec3d from, Vec3d to,
                            Pace& pace) noexcept;

/// The component inside the other body that a pair of triangles is of; null where it is of none.
/// O(Containment::count)
[[nodiscard]] const Contained* contained_of(const Containment& kept, const PairFrame& frame,
                                            const Witness& pair) noexcept;

/// Settles for every pair what of one body is inside the other, where that is in doubt: where a
/// vertex of one is inside the other, the whole component is, unless it crosses it: what does is
/// asked for once they have parted, and what is inside beside it in every tick. Where more than 32
/// pairs of components cross each other, all count as crossing. Components are
/// asked for one after another, a's before b's, which are not asked for where all of a is inside.
/// Beyond kMostContained that are inside at once others are not felt before they come near a
/// surface, and the question stays open. Images from before 1.5 do not tell several ones apart, and
/// are not asked for. Of each that is inside and near no surface some pair is measured, about the
/// nearest. Cost: side_of(), and a unit, for each component of each pair in doubt; but at most half
/// of what a budget has left unless the bodies have jumped, the rest in the ticks to come. Then
/// kUnitsOfLooks for each that is inside. O(active) a pair.
void settle_sides(Work& work) noexcept;

/// The same where nothing is felt and one body seems to be inside the other, as a body is that has
/// gone through a surface by more than it is wide between two ticks.
void settle_suspected_sides(Work& work) noexcept;

/// The same wherever no contact is certain and one body may be inside the other, in this tick as
/// far as the budget goes.
void settle_open_sides(Work& work) noexcept;

/// Finds the nearest pair of all of every component that is inside and not near the surface
/// (Containment::leaving). Where nothing is felt, and it is not proved that the bodies have not
/// passed through each other since the tick before, it settles that first.
/// Cost: what is left of the budget at most.
void find_ways_out(Work& work) noexcept;

/// Whether what is not felt may lie inside the other body: of bodies that feel nothing, or beside a
/// component that is inside. O(active) a pair
[[nodiscard]] bool may_be_inside(const Work& work) noexcept;

/// Whether it may, and no contact of those two bodies is certain. O(active) a pair
[[nodiscard]] bool may_touch_inside(const Work& work) noexcept;

}  // namespace palpate::regions

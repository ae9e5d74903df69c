// SPDX-License-Identifier: Apache-2.0
// What the search for the least push keeps from tick to tick, and what it has found.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/force/least_push.hpp"
#include "rt_core/regions/likely.hpp"
#include "rt_core/regions/side_view.hpp"

namespace palpate::regions {

/// "Not known", and farther or deeper than anything.
inline constexpr double kUnknown = 1e300;

/// Of a region's signed distance from the other body. An odometer (SideView::odometer) tells how
/// far the bodies have moved: a bound less the motion since is still a bound.
struct RegionBound {
  double lower_until = -kUnknown;  ///< lower bound plus the odometer when it was proved
  double upper_since = kUnknown;   ///< what the centre proved last, less the odometer then
};

/// Of a vertex's signed distance from the other body.
struct VertexBound {
  double lower_until = -kUnknown;
  std::uint32_t nearest = image::kNone;  ///< triangle of the other body
  std::uint32_t measured_tick = 0;
};

/// What is kept of one side of a pair from tick to tick.
struct SideMemory {
  std::span<RegionBound> regions;
  std::span<VertexBound> vertices;
  std::span<std::uint32_t> edge_ticks;  ///< in which each edge was last measured
  LikelyMemory likely;
};

/// A region that may be within reach in this tick.
struct NearRegion {
  double lower = 0;     ///< of what of it has not been measured in this tick
  double priority = 0;  ///< LikelyContacts::promise
  std::uint32_t side = 0;
  std::uint32_t region = 0;
  std::uint32_t settled = 0;  ///< nothing of it was open for this version of the explanation
};

/// What was carrying in the last tick: measured first in the next.
struct WarmStart {
  ContactSource sources[force::kMostCarrying];
  std::uint32_t count = 0;
};

/// Borrowed from the engine.
struct ContactMemory {
  const Kernels* kernels = nullptr;
  std::span<levels::PairState> pairs;
  std::span<const BodyPair> bodies;
  std::uint32_t tool = 0;
  std::span<SideMemory> sides;                   ///< [2 * pairs]: a against b, b against a
  std::span<SideView> views;                     ///< likewise, of this tick
  std::span<NearRegion> near;                    ///< [sum of regions over sides]
  std::span<std::uint32_t> queue;                ///< likewise
  std::span<LikelyContact> likely;               ///< [sum of vertices over sides]
  std::span<Contact> contacts;                   ///< [limits.contacts]
  std::span<ContactSource> sources;              ///< likewise
  std::span<force::PushConstraint> constraints;  ///< likewise
  contact::Scratch* scratch = nullptr;           ///< [1]
  WarmStart warm;
  PushSoFar push;
  std::uint32_t tick = 0;
  std::uint64_t measure_ns = 0;  ///< that measuring one vertex or edge takes, about

  [[nodiscard]] bool is_measured(const ContactSource& source) const noexcept {
    const SideMemory& side = sides[source.side];
    return tick == (source.is_edge() ? side.edge_ticks[source.index()]
                                     : side.vertices[source.index()].measured_tick);
  }
};

/// What a search has found.
struct ContactSearchResult {
  std::uint32_t contacts = 0;               ///< the first of ContactMemory::contacts
  force::PushResult push;                   ///< of their constraints, in metres
  double strongest_m = 0;                   ///< the largest strength of a contact
  double error_m = 0;                       ///< how far the push may be off, in length
  Contact nearest{.distance_m = kUnknown};  ///< the nearest points measured, whether they face each
                                            ///< other or not; below 0: a vertex that is inside
  double lower_m = kUnknown;   ///< bound of the signed distance of what has not been measured
  std::uint32_t likely = 0;    ///< the first of ContactMemory::likely
  bool push_proved = false;    ///< nothing left changes the push by more than is tolerated
  bool places_proved = false;  ///< nothing left changes where it acts
  bool contacts_full = false;
};

}  // namespace palpate::regions

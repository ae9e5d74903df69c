// SPDX-License-Identifier: Apache-2.0
// Measures regions, vertices and edges for a contact search.
#pragma once

#include "rt_core/base/pace.hpp"
#include "rt_core/regions/contact_memory.hpp"

namespace palpate::regions {

/// By how much a contact may change the push, as far as is known of it.
class Explanation {
 public:
  force::Push push;   ///< on the contacts known
  double share = 1;   ///< of it that explains: 1 for the force, less for the torque
  bool edges = true;  ///< edges are measured too
  double delta_m = 0;
  double strongest_m = 0;   ///< of the contacts known: what fades is weaker the stronger it is
  double negligible_m = 0;  ///< what exceeds the push by no more may stay open

  std::uint32_t version = 0;  ///< changes with the push and the share

  /// @param axis, cosine  a cone of P's normals; -1: all directions
  /// @return the largest strength, in metres, of a contact there that changes nothing
  [[nodiscard]] double explained_m(const SideView& view, Vec3d axis, double cosine) const noexcept;
  [[nodiscard]] double explained_m(const SideView& view, std::uint32_t region) const noexcept;
  /// By how much a contact may exceed that.
  /// @param lower  bound of its points' signed distance, in units of the pair
  [[nodiscard]] double excess_m(const SideView& view, double explained_m,
                                double lower) const noexcept;
  [[nodiscard]] bool is_open(double excess) const noexcept;
  /// The largest strength of a contact of a point whose signed distance is no less.
  [[nodiscard]] double strength_of_distance(double lower_m) const noexcept;
};

class Measuring {
 public:
  Measuring(ContactMemory& memory, Pace*& pace, const Explanation& explanation,
            ContactSearchResult& out) noexcept
      : memory_(memory), pace_(pace), explanation_(explanation), out_(out) {}

  void source(const ContactSource& source) noexcept;

  /// Tightens the bounds of a region where that may tell more than is known; else measures what is
  /// open of it.
  void region(NearRegion& item) noexcept;

 private:
  /// One pass over a region.
  struct Visit {
    double lower = -kUnknown;      ///< of everything, before it; NearRegion::lower is of less
    double unmeasured = kUnknown;  ///< least bound of what has not been measured in this tick
    double least = kUnknown;       ///< of everything
    double explained_m = 0;        ///< by all directions of the region
    bool open = false;             ///< something that is open was left or measured
  };
  bool measures(const SideView& view, const contact::NormalCone& cone, double lower,
                Visit& visit) noexcept;
  void visit_vertex(const NearRegion& item, std::uint32_t vertex, Visit& visit) noexcept;
  void visit_edge(const NearRegion& item, std::uint32_t index, Visit& visit) noexcept;
  bool tighten(NearRegion& item) noexcept;
  double edge_bound(const ContactSource& edge, double region_lower) const noexcept;
  [[nodiscard]] std::uint32_t hint_of(std::uint32_t side, std::uint32_t vertex) const noexcept;
  void vertex(std::uint32_t side, std::uint32_t index) noexcept;
  void edge(std::uint32_t side, std::uint32_t index) noexcept;
  void take(const ContactSource& source) noexcept;
  [[nodiscard]] Contact contact_of(const SideView& view,
                                   const contact::FoundContact& found) const noexcept;
  void note_nearest(const SideView& view, const contact::FoundContact& found) noexcept;

  ContactMemory& memory_;
  Pace*& pace_;
  const Explanation& explanation_;
  ContactSearchResult& out_;
};

}  // namespace palpate::regions

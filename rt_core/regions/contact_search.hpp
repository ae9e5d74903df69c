// SPDX-License-Identifier: Apache-2.0
// Finds the contacts that can change the force (constraint generation, docs/CONTACT.md).
//
// For each region of both bodies there is a lower bound of its signed distance from the other body.
// With the cone of its normals it bounds the strength of every contact that the region can have.
// A region is explained where the least push on the contacts known so far already pushes at least
// as far in all these directions: then nothing in it can change the force. The others are measured,
// vertices first, until none is left or the budget ends.
#pragma once

#include <cstdint>

#include "rt_core/base/pace.hpp"
#include "rt_core/regions/contact_memory.hpp"
#include "rt_core/regions/measure.hpp"

namespace palpate::regions {

/// What is asked of a search.
struct PushDemand {
  double delta_m = 0;      ///< contact tolerance
  double tolerance_m = 0;  ///< the push may be off by so much; 0: exact
};

/// One tick's search. Poses are set (levels::move). guess() comes first, then whatever else is
/// asked for, prove_places() after prove_push(), then conclude().
class ContactSearch {
 public:
  /// O(regions)
  ContactSearch(ContactMemory& memory, const PushDemand& demand) noexcept;

  /// Measures what carried in the tick before, and vertices that are likely to change the push
  /// (likely.hpp), those first that may change it most, until none is.
  /// Cost: the budget and one contact's evaluation, and O(regions).
  void guess(Pace& pace) noexcept;
  /// Measures what is not proved to leave the push as it is, until all is.
  /// Cost: the budget and one contact's evaluation; without a budget at most kMostRounds solutions
  /// of the push, twice.
  void prove_push(Pace& pace) noexcept;
  /// Measures edges on which minima lie (minima.hpp) and that may change the push.
  /// @param edges  [minima] of body a's surface_edges, or kNone
  /// Cost: as guess()
  void see_minima(Pace& pace, std::span<const Contact> minima,
                  std::span<const std::uint32_t> edges) noexcept;
  /// Whether a vertex of each component of every body is known to be outside the other body of its
  /// pair; where the grid does not tell, it is measured.
  /// Cost: a unit and a look at the grid for each component, and the budget
  bool see_components(Pace& pace) noexcept;
  /// Likewise what may count in the torque.
  void prove_places(Pace& pace) noexcept;
  /// Bounds what is left, and keeps what carries for the next tick. O(regions)
  const ContactSearchResult& conclude() noexcept;
  /// How many are known, measured or likely.
  [[nodiscard]] std::uint32_t contacts() const noexcept { return out_.contacts + out_.likely; }
  /// Of the nearest points measured, signed.
  [[nodiscard]] double nearest_m() const noexcept { return out_.nearest.distance_m; }

 private:
  void gather() noexcept;
  LikelyContacts likely_contacts(std::uint32_t side) noexcept;
  void look_and_measure() noexcept;
  std::uint32_t collect_due() noexcept;
  bool may_measure() noexcept;
  void measure(const ContactSource& source) noexcept;
  void measure_likely(std::uint32_t most) noexcept;
  const LikelyContact* most_violated() noexcept;
  [[nodiscard]] double least_lower_m() const noexcept;
  double raised_by_grid(const NearRegion& item) noexcept;
  bool explain(double share, bool edges) noexcept;
  double excess_m(const NearRegion& item) const noexcept;
  void solve() noexcept;
  void bound_error() noexcept;

  ContactMemory& memory_;
  PushDemand demand_;
  Pace* pace_ = nullptr;
  ContactSearchResult out_;
  Explanation explanation_;
  Measuring measure_;
  std::uint32_t near_ = 0;
  std::uint32_t solved_ = 0;  // so many contacts the push is of
  double likely_strongest_m_ = 0;
};

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
// Finds the contacts that can change the force (constraint generation, docs/CONTACT.md).
//
// For each region of both bodies there is a lower bound of its signed distance from the other body.
// With the cone of its normals it bounds the strength of every contact that the region can have.
// A region is explained where the least push on the contacts known so far already pushes at least
// as far in all these directions: then nothing in it can change the force. The others are measured,
// those first that can change it most, until none is left or the budget ends.
#pragma once

#include <cstdint>

#include "rt_core/base/pace.hpp"
#include "rt_core/regions/contact_memory.hpp"
#include "rt_core/regions/measure.hpp"

namespace palpate::regions {

/// One tick's search. Poses are set (levels::move). guess() comes first, then prove() where the
/// push has to be exact, then conclude().
class ContactSearch {
 public:
  /// @param delta_m  contact tolerance
  ContactSearch(ContactMemory& memory, double delta_m) noexcept;

  /// Measures what carried in the tick before, and vertices that are likely to change the push
  /// (likely.hpp), those first that may change it most, until none is.
  /// Cost: the budget and one contact's evaluation, and O(regions).
  void guess(Pace& pace) noexcept;
  /// Measures what is not proved to change nothing, until all is.
  /// Cost: the budget and one contact's evaluation; without a budget at most kMostRounds solutions
  /// of the push.
  void prove(Pace& pace) noexcept;
  /// Bounds what is left, and keeps what carries for the next tick. O(regions)
  const ContactSearchResult& conclude() noexcept;

 private:
  void gather() noexcept;
  void look_and_measure() noexcept;
  void measure_likely(std::uint32_t most) noexcept;
  const LikelyContact* most_violated() noexcept;
  bool explain(double share, bool edges) noexcept;
  double excess_m(const NearRegion& item) const noexcept;
  std::uint32_t collect_open() noexcept;
  void solve() noexcept;
  void bound_error() noexcept;

  ContactMemory& memory_;
  Pace* pace_ = nullptr;
  ContactSearchResult out_;
  Explanation explanation_;
  Measuring measure_;
  std::uint32_t near_ = 0;
  double likely_strongest_m_ = 0;
  bool force_proved_ = false;
};

/// How far unmeasured contacts may leave the push off: those that are missing, and those that fade
/// more the stronger the strongest is.
[[nodiscard]] double push_error_m(const ContactSearchResult& found) noexcept;

}  // namespace palpate::regions

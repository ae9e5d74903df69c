// SPDX-License-Identifier: Apache-2.0
// Counts the work of a tick against its budget.
#pragma once

#include <cstdint>
#include <limits>

#include "rt_core/palpate_rt.hpp"

namespace palpate {

/// Brings a time nearer to what it was this tick, within a few ticks, or all the way where it is
/// not known (0); one that was interrupted by the host counts for little.
inline void follow(std::uint64_t& time_ns, std::uint64_t now_ns) noexcept {
  constexpr std::uint64_t kLeast_ns = 1000;
  const std::uint64_t most = 4 * time_ns + kLeast_ns;
  const std::uint64_t now = now_ns < most ? now_ns : most;
  time_ns = time_ns > 0 ? (3 * time_ns + now) / 4 : now;
}

/// How long the tail of a tick takes for each of its contacts, learnt from ticks.
class TailTime {
 public:
  /// Of a whole tail; a quarter more than it took, since it wavers.
  [[nodiscard]] std::uint64_t expected_ns(std::uint64_t contacts) const noexcept {
    return contact_ns_ * (contacts + kFixed) * 5 / 4;
  }
  /// Of how many contacts the tail is expected to take this time; infinitely many where they take
  /// none.
  [[nodiscard]] double contacts_in(std::uint64_t tail_ns) const noexcept {
    if (contact_ns_ == 0) return std::numeric_limits<double>::infinity();
    return static_cast<double>(4 * tail_ns) / static_cast<double>(5 * contact_ns_) -
           static_cast<double>(kFixed);
  }
  void learn(std::uint64_t tail_ns, std::uint64_t contacts) noexcept {
    follow(contact_ns_, tail_ns / (contacts + kFixed));
  }

 private:
  static constexpr std::uint64_t kFixed = 4;  ///< what a tail takes beside, in contacts
  /// Until ticks have told; what desktop processors take.
  static constexpr std::uint64_t kAssumed_ns = 400;
  std::uint64_t contact_ns_ = kAssumed_ns;
};

/// The clock is read before every query: it is handed in and cheap (a cycle counter, a vDSO call).
/// Refinement has to end early enough for what follows it (clusters, forces): the tail, whose time
/// grows with the contacts. It is left at most half of what there is.
class Meter {
 public:
  Meter(const Budget& budget, const TailTime& tail) noexcept : budget_(budget), tail_(tail) {
    stop_units_ = budget.units;
    if (budget.clock_ns == nullptr) return;
    start_ns_ = tail_start_ns_ = now_ns();
    stop_ns_ = budget.deadline_ns;
    leave_for_tail(0);
  }

  /// So many contacts there are or will be; fewer than before change nothing. Where time is
  /// limited, refinement ends the sooner. O(1)
  void expect_contacts(std::uint64_t contacts) noexcept {
    if (contacts <= contacts_) return;
    contacts_ = contacts;
    if (budget_.clock_ns != nullptr) leave_for_tail(contacts);
  }

  /// How many contacts there is time for in the tail, of which it is left half of the budget; below
  /// 0 where there is none.
  [[nodiscard]] double contacts_affordable() const noexcept {
    if (!limited_in_time()) return std::numeric_limits<double>::infinity();
    return tail_.contacts_in(half_ns());
  }

  void charge(std::uint64_t units) noexcept { used_ += units; }
  [[nodiscard]] std::uint64_t used() const noexcept { return used_; }

  /// What lets the tick go on: of units, of time, or of both where both have ended it.
  [[nodiscard]] bool has_reserve() const noexcept {
    const bool of_units = budget_.units != kUnlimited && budget_.reserve_units > 0;
    const bool of_time = limited_in_time() && budget_.reserve_ns > 0;
    if (!of_units && !of_time) return false;  // no clock is read
    const bool units_do = of_units || used_ < budget_.units;
    return units_do && (of_time || !limited_in_time() || now_ns() < end_ns_);
  }
  /// It is to be had from here on, and what was set aside as well; then it is gone.
  void draw_on_reserve() noexcept {
    budget_.units = sum_of(budget_.units, budget_.reserve_units);
    budget_.deadline_ns = sum_of(budget_.deadline_ns, budget_.reserve_ns);
    budget_.reserve_units = budget_.reserve_ns = 0;
    if (budget_.clock_ns != nullptr) leave_for_tail(contacts_);
    stop_units_ = budget_.units;
    stop_ns_ = end_ns_;
  }

  /// Units left, as far as a counter of 32 bits tells.
  [[nodiscard]] std::uint32_t queries_left() const noexcept {
    constexpr std::uint64_t kMost = 0xffffffffu;
    const std::uint64_t left = stop_units_ > used_ ? stop_units_ - used_ : 0;
    return static_cast<std::uint32_t>(left < kMost ? left : kMost);
  }
  /// What units and time are expected to do for; infinity where neither is limited.
  /// @param query_ns  time that one is expected to take; 0: unknown
  [[nodiscard]] double queries_affordable(std::uint64_t query_ns) const noexcept {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double units =
        budget_.units == kUnlimited ? kInfinity : static_cast<double>(queries_left());
    if (budget_.clock_ns == nullptr || query_ns == 0) return units;
    const std::uint64_t now = now_ns();
    const double time = stop_ns_ > now ? static_cast<double>(stop_ns_ - now) : 0;
    const double in_time = time / static_cast<double>(query_ns);
    return in_time < units ? in_time : units;
  }
  /// Whether something that takes so long may still be begun.
  [[nodiscard]] bool has_time_for(std::uint64_t ns) const noexcept {
    return !limited_in_time() || now_ns() + ns < stop_ns_;
  }
  /// Since the meter was made; 0 without a clock.
  [[nodiscard]] std::uint64_t elapsed_ns() const noexcept {
    return budget_.clock_ns != nullptr ? now_ns() - start_ns_ : 0;
  }
  /// From when the meter was made to begin_tail(); 0 without a clock.
  [[nodiscard]] std::uint64_t refined_ns() const noexcept { return tail_start_ns_ - start_ns_; }
  /// Can the budget end the tick at all?
  [[nodiscard]] bool limited() const noexcept {
    return limited_in_time() || budget_.units != kUnlimited;
  }
  [[nodiscard]] bool out_of_units() const noexcept { return used_ >= stop_units_; }
  [[nodiscard]] bool out_of_time() const noexcept {
    return budget_.clock_ns != nullptr && now_ns() >= stop_ns_;
  }

  /// Marks the end of refinement: the tail begins. Of what was left for it all units and three
  /// quarters of the time are to be had again; the rest of the time is for what is not searched.
  void begin_tail() noexcept {
    constexpr std::uint64_t kQuarters = 4;
    stop_units_ = budget_.units;
    if (budget_.clock_ns == nullptr) return;
    tail_start_ns_ = now_ns();
    stop_ns_ = budget_.deadline_ns;
    if (stop_ns_ > tail_start_ns_) stop_ns_ -= (stop_ns_ - tail_start_ns_) / kQuarters;
  }
  /// Since begin_tail(); 0 without a clock.
  [[nodiscard]] std::uint64_t tail_ns() const noexcept {
    return budget_.clock_ns != nullptr ? now_ns() - tail_start_ns_ : 0;
  }

 private:
  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

  [[nodiscard]] bool limited_in_time() const noexcept {
    return budget_.clock_ns != nullptr && budget_.deadline_ns != kUnlimited;
  }

  static std::uint64_t sum_of(std::uint64_t limit, std::uint64_t more) noexcept {
    return more < kUnlimited - limit ? limit + more : kUnlimited;
  }

  [[nodiscard]] std::uint64_t half_ns() const noexcept {
    return budget_.deadline_ns > start_ns_ ? (budget_.deadline_ns - start_ns_) / 2 : 0;
  }

  void leave_for_tail(std::uint64_t contacts) noexcept {
    const std::uint64_t half = half_ns();
    const std::uint64_t tail_ns = tail_.expected_ns(contacts);
    end_ns_ = budget_.deadline_ns - (tail_ns < half ? tail_ns : half);
    if (stop_ns_ > end_ns_) stop_ns_ = end_ns_;
  }

  [[nodiscard]] std::uint64_t now_ns() const noexcept {
    return budget_.clock_ns(budget_.clock_context);
  }

  Budget budget_;
  TailTime tail_;
  std::uint64_t contacts_ = 0;  ///< expected
  std::uint64_t used_ = 0;
  std::uint64_t start_ns_ = 0;
  std::uint64_t stop_units_ = 0;  ///< where the budget ends, or what is set aside begins
  std::uint64_t stop_ns_ = 0;     ///< likewise
  std::uint64_t end_ns_ = 0;
  std::uint64_t tail_start_ns_ = 0;
};

}  // namespace palpate

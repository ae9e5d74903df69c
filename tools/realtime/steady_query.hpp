// SPDX-License-Identifier: GPL-3.0-or-later
// What a change of level or of budget does to the wrench comes at a stated rate, not as a blow, and
// what may not be true of it no faster than the wrench usually changes.
#pragma once

#include "rt_core/force/linear_contact.hpp"
#include "tools/realtime/contact_query.hpp"
#include "tools/realtime/doubt.hpp"

namespace palpate::realtime {

/// How fast the wrench may leave its linear model; > 0, infinity: at once. Their ratio is the lever
/// arm at which a force counts as a torque.
struct SteadyRates {
  double force_N_per_s = 150;
  double torque_Nm_per_s = 3;
};

/// Another query's answer, followed steadily.
///
/// Two steps. First, what may not be true is not believed at once (doubt.hpp). The certificate
/// leaves open by how much the least distance is off: the stiffness makes a doubt of force of that,
/// kDoubt times as large, for the distance is not the only one. A change of the wrench is certain
/// as far as it is larger than the doubts of this tick and of the last; and so is what the linear
/// model says (linear_contact.hpp), less what a slope of kSlope makes of the motion, which a
/// simplified surface may have where the original has none. How deep bodies overlap where a budget
/// ended the query, the certificate need not tell: then no more is certain than kDeepShare of what
/// the stiffness makes of the motion, and what the model says. So an exact answer, which leaves
/// nothing open, is believed at once and whole; simplified contacts, whose slopes and corners are
/// not those of the original, and those that a budget finds late, come in as the force changes
/// anyway.
///
/// Then the wrench is expected to follow its linear model: what the tool's motion does to the
/// contacts it has. All else, contacts that come and go, levels that change, a budget that moves
/// the cut, is followed at the rates given and no faster. So the force changes by no more between
/// two ticks than the stiffness makes of the motion, and rate times period. The certificate's
/// distances are those of the contacts; its force_bound_N is widened by off(), by which the wrench
/// differs from theirs. For direct coupling: a simulated tool smooths by its own mass, and must not
/// be let through. O(1)
class SteadyQuery final : public ContactQuery {
 public:
  /// @param contacts            outlives this; asked once a period
  /// @param stiffness_N_per_m   of the contacts in any one direction; 0: nothing is doubted
  SteadyQuery(ContactQuery& contacts, const SteadyRates& rates, double stiffness_N_per_m,
              double period_s) noexcept;

  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override;

  /// The wrench answered last less that of the contacts.
  [[nodiscard]] const Wrench& off() const noexcept { return off_; }

 private:
  static constexpr double kDoubt = 1.5;
  static constexpr double kSlope = 0.4;
  static constexpr double kDeepShare = 0.6;
  /// Of the rates: what is let in however smooth a contact is.
  static constexpr double kLeastShare = 1.0 / 75;

  /// The first step.
  /// @param way   of the tool since the last tick
  /// @param fall  what the last tick's stiffness makes of it
  [[nodiscard]] Wrench believed(const TickResult& found, const Vec6& way,
                                const Vec6& fall) noexcept;

  ContactQuery& contacts_;
  double most_N_;  ///< the rates times a period
  double most_Nm_;
  double arm_m_;
  double stiffness_N_per_m_;
  bool begun_ = false;
  double before_doubt_N_ = 0;
  Doubtful force_N_;
  Doubtful torque_Nm_;
  force::LinearContact before_;  ///< with the wrench that was answered
  Wrench off_;
};

}  // namespace palpate::realtime

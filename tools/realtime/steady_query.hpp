// SPDX-License-Identifier: GPL-3.0-or-later
// What a change of level or of budget does to the wrench comes at a stated rate, not as a blow.
#pragma once

#include "rt_core/force/linear_contact.hpp"
#include "tools/realtime/contact_query.hpp"

namespace palpate::realtime {

/// How fast the wrench may leave its linear model; > 0, infinity: at once.
struct SteadyRates {
  double force_N_per_s = 150;
  double torque_Nm_per_s = 3;
};

/// Another query's answer, followed steadily.
///
/// From one tick to the next the wrench is expected to follow its linear model
/// (linear_contact.hpp): what the tool's motion does to the contacts it has. All else, contacts
/// that come and go, levels that change, a budget that moves the cut, is followed at the rates
/// given and no faster. So the force changes by no more between two ticks than the stiffness makes
/// of the motion, and rate times period. The certificate's distances are those of the contacts; its
/// force_bound_N is widened by off(), by which the wrench differs from theirs. For direct coupling:
/// a simulated tool smooths by its own mass, and must not be let through.
class SteadyQuery final : public ContactQuery {
 public:
  /// @param contacts  outlives this; asked once a period
  SteadyQuery(ContactQuery& contacts, const SteadyRates& rates, double period_s) noexcept
      : contacts_(contacts), rates_(rates), period_s_(period_s) {}

  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override;

  /// The wrench answered last less that of the contacts.
  [[nodiscard]] const Wrench& off() const noexcept { return off_; }

 private:
  ContactQuery& contacts_;
  SteadyRates rates_;
  double period_s_;
  force::LinearContact before_;  ///< with the wrench that was answered
  Wrench off_;
};

}  // namespace palpate::realtime

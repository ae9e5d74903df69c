// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts that resist velocity, felt directly.
#pragma once

#include "tools/realtime/contact_query.hpp"

namespace palpate::realtime {

/// Another query's answer, damped (rt_core/force/linear_contact.hpp) with the velocity of the tool
/// since the last tick. Coupled virtually, the simulated tool does this itself.
class DampedQuery final : public ContactQuery {
 public:
  /// @param damping_s  damping over stiffness  @param contacts  outlives this
  DampedQuery(ContactQuery& contacts, double damping_s, double period_s)
      : contacts_(contacts), damping_s_(damping_s), period_s_(period_s) {}

  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override;

 private:
  ContactQuery& contacts_;
  double damping_s_;
  double period_s_;
  Pose before_;
  bool placed_ = false;
};

}  // namespace palpate::realtime

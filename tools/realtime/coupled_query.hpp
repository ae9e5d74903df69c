// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts felt through a virtual coupling.
#pragma once

#include "rt_core/force/coupling.hpp"
#include "tools/realtime/contact_query.hpp"

namespace palpate::realtime {

/// Asks another query at the pose of a simulated tool, moves that tool on by one period, and
/// answers with the wrench of the coupling. Contacts and certificate are those of the simulated
/// tool. Force limits belong behind this, not into the query: limited contacts would let the tool
/// through.
class CoupledQuery final : public ContactQuery {
 public:
  /// `contacts` must outlive this. The first tick puts the simulated tool where the handle is.
  CoupledQuery(ContactQuery& contacts, const force::CouplingSettings& settings, double period_s);

  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override;

 private:
  ContactQuery& contacts_;
  force::VirtualTool tool_;
  double period_s_;
  bool placed_ = false;
};

}  // namespace palpate::realtime

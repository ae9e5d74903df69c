// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/coupled_query.hpp"

namespace palpate::realtime {

CoupledQuery::CoupledQuery(ContactQuery& contacts, const force::CouplingSettings& settings,
                           double period_s)
    : contacts_(contacts), tool_(settings), period_s_(period_s) {}

Status CoupledQuery::tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept {
  if (!placed_) tool_.reset(tool);
  placed_ = true;
  const Status status = contacts_.tick(tool_.pose(), budget, out);
  if (status == Status::ok) {
    out.wrench = tool_.step(tool, out.wrench, out.stiffness, period_s_);
  }
  return status;
}

}  // namespace palpate::realtime

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/damped_query.hpp"

#include "rt_core/force/displacement.hpp"
#include "rt_core/force/linear_contact.hpp"

namespace palpate::realtime {

Status DampedQuery::tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept {
  const Status status = contacts_.tick(tool, budget, out);
  if (status != Status::ok) return status;
  if (placed_) {
    Vec6 velocity = force::displacement(before_, tool);
    for (double& v : velocity) v /= period_s_;
    out.wrench = force::damped(out.wrench, out.stiffness, velocity, damping_s_);
  }
  before_ = tool;
  placed_ = true;
  return status;
}

}  // namespace palpate::realtime

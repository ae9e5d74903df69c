// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/steady_query.hpp"

namespace palpate::realtime {
namespace {

/// What is left of a difference after coming nearer by a step.
Vec3d less(const Vec3d& difference, double step) {
  const double length = norm(difference);
  return length > step ? (1 - step / length) * difference : Vec3d{};
}

}  // namespace

Status SteadyQuery::tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept {
  const Status status = contacts_.tick(tool, budget, out);
  if (status != Status::ok) return status;
  const Wrench expected = force::predicted(before_, tool);
  off_ = {less(expected.force_N - out.wrench.force_N, rates_.force_N_per_s * period_s_),
          less(expected.torque_Nm - out.wrench.torque_Nm, rates_.torque_Nm_per_s * period_s_)};
  out.wrench.force_N += off_.force_N;
  out.wrench.torque_Nm += off_.torque_Nm;
  out.certificate.force_bound_N += norm(off_.force_N);
  before_ = {tool, out.wrench, out.stiffness};
  return status;
}

}  // namespace palpate::realtime

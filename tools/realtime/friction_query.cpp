// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/friction_query.hpp"

namespace palpate::realtime {

FrictionQuery::FrictionQuery(ContactQuery& contacts, std::span<const BodyPair> pairs,
                             std::uint32_t tool, const Settings& settings,
                             std::span<const Pose> poses, std::span<const double> coefficients)
    : contacts_(contacts),
      pairs_(pairs.begin(), pairs.end()),
      tool_(tool),
      settings_(settings),
      poses_(poses.begin(), poses.end()),
      coefficients_(coefficients.begin(), coefficients.end()),
      sticks_(pairs.size()),
      friction_(coefficients_, sticks_) {}

Status FrictionQuery::tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept {
  const Status status = contacts_.tick(tool, budget, out);
  if (status != Status::ok) return status;
  poses_[tool_] = tool;
  friction_.add(pairs_, tool_, settings_, poses_, out);
  return status;
}

}  // namespace palpate::realtime

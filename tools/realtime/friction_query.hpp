// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts with friction.
#pragma once

#include <span>
#include <vector>

#include "rt_core/force/friction.hpp"
#include "tools/realtime/contact_query.hpp"

namespace palpate::realtime {

/// Adds friction to another query's answer; every body but the tool stays where it was put. Only
/// scenes that ask for friction need one.
class FrictionQuery final : public ContactQuery {
 public:
  /// @param contacts      outlives this; its wrench must not be limited
  /// @param poses         [bodies]
  /// @param coefficients  [pairs]
  FrictionQuery(ContactQuery& contacts, std::span<const BodyPair> pairs, std::uint32_t tool,
                const Settings& settings, std::span<const Pose> poses,
                std::span<const double> coefficients);

  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override;

 private:
  ContactQuery& contacts_;
  std::vector<BodyPair> pairs_;
  std::uint32_t tool_;
  Settings settings_;
  std::vector<Pose> poses_;
  std::vector<double> coefficients_;
  std::vector<force::Stick> sticks_;
  force::Friction friction_;
};

}  // namespace palpate::realtime

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/spacemouse/leader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::spacemouse {
namespace {

constexpr int kAtRest = 15;
constexpr int kAllTheWay = 350;
constexpr std::chrono::milliseconds kLookEvery(50);

double bent(int value) {
  const int size = std::clamp(std::abs(std::clamp(value, -kAllTheWay, kAllTheWay)) - kAtRest, 0,
                              kAllTheWay - kAtRest);
  const double share = static_cast<double>(size) / (kAllTheWay - kAtRest);
  return value < 0 ? -share * share : share * share;
}

Vec3d bent(const std::array<int, 3>& values) {
  return {bent(values[0]), bent(values[1]), bent(values[2])};
}

}  // namespace

hal::mock::Lead lead_of(Heard heard, const Deflection& deflection, const Pace& pace) noexcept {
  hal::mock::Lead lead;
  lead.held = heard == Heard::deflection;
  lead.paced = lead.held;
  lead.pace = {pace.speed_m_per_s * bent(deflection.push),
               pace.turn_rad_per_s * bent(deflection.turn)};
  return lead;
}

Leader::Leader(std::unique_ptr<Puck> puck, const Pace& pace,
               std::function<void(const hal::mock::Lead&)> lead, std::function<void()> on_gone)
    : puck_(std::move(puck)),
      pace_(pace),
      lead_(std::move(lead)),
      on_gone_(std::move(on_gone)),
      thread_([this] { run(); }) {}

Leader::~Leader() {
  stopping_ = true;
  thread_.join();
}

void Leader::run() {
  Heard heard = Heard::nothing;
  while (!stopping_ && heard != Heard::gone) {
    Deflection deflection;
    heard = puck_->next(deflection, kLookEvery);
    if (heard != Heard::nothing) lead_(lead_of(heard, deflection, pace_));
  }
  if (heard == Heard::gone) on_gone_();
}

}  // namespace palpate::spacemouse

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate-sim/device_log.hpp"

#include <array>
#include <chrono>
#include <cstdio>

namespace palpate::sim {
namespace {

/// By hal::protocol::Mode.
constexpr std::array kModes = {"idle", "homing", "active", "expired", "fault"};

}  // namespace

void DeviceLog::look() {
  if (device_ == nullptr) return;
  const auto& rendered = device_->rendered();
  const bool force = norm(rendered.force_N) + norm(rendered.torque_Nm) > 0;
  if (any_ && force == force_ && device_->mode() == mode_) return;
  const bool let_go = any_ && force_ && !force;
  any_ = true;
  force_ = force;
  mode_ = device_->mode();
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  std::printf("%.6f %s, %s", now.count(), kModes.at(static_cast<std::size_t>(mode_)),
              force ? "force" : "no force");
  constexpr std::uint64_t kNsPerUs = 1000;
  if (let_go) {
    std::printf(" %llu us after the last command with one",
                static_cast<unsigned long long>(device_->since_force_ns() / kNsPerUs));
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace palpate::sim

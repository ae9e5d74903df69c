// SPDX-License-Identifier: GPL-3.0-or-later
// Leads a simulated hand by a puck.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "hal/mock/follower.hpp"
#include "tools/spacemouse/puck.hpp"

namespace palpate::spacemouse {

/// Of a puck pushed and turned all the way.
struct Pace {
  double speed_m_per_s = 0.05;
  double turn_rad_per_s = 1.5;
};

/// What a deflection leads to; a button, and what is gone, let go. Near its rest a puck is at rest,
/// and beyond it slow ways are fine ones: the pace grows with the square.
[[nodiscard]] hal::mock::Lead lead_of(Heard heard, const Deflection& deflection,
                                      const Pace& pace) noexcept;

class Leader {
 public:
  /// Leads from a thread of its own for as long as this lives.
  /// @param lead     as MockDevice::lead()
  /// @param on_gone  told once where the puck is gone, on that thread
  Leader(std::unique_ptr<Puck> puck, const Pace& pace,
         std::function<void(const hal::mock::Lead&)> lead, std::function<void()> on_gone);
  ~Leader();
  Leader(const Leader&) = delete;
  Leader& operator=(const Leader&) = delete;
  Leader(Leader&&) = delete;
  Leader& operator=(Leader&&) = delete;

 private:
  void run();

  std::unique_ptr<Puck> puck_;
  Pace pace_;
  std::function<void(const hal::mock::Lead&)> lead_;
  std::function<void()> on_gone_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace palpate::spacemouse

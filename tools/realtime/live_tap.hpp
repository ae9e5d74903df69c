// SPDX-License-Identifier: GPL-3.0-or-later
// What a live view sees of the loop: every tick's record, and now and then a tick's contacts. The
// loop's side is wait-free; the other side is read by one thread.
#pragma once

#include <array>
#include <cstdint>

#include "hal/exchange.hpp"
#include "hal/ring.hpp"
#include "rt_core/palpate_rt.hpp"
#include "tools/realtime/trace.hpp"

namespace palpate::realtime {

/// Contacts of one tick that are shown at most.
inline constexpr std::uint32_t kMostLiveContacts = 96;

/// World axes, metres from the view's origin.
struct LiveContact {
  std::array<float, 3> centre_m{};
  std::array<float, 3> normal{};
  float distance_m = 0;
  float force_N = 0;  ///< that it carries, before limits
};

/// One tick's contacts and what is certain about them.
struct LiveTick {
  Pose tool;                  ///< at which they were found: a simulated tool's where there is one
  Certificate certificate;    ///< of this tick
  double min_distance_m = 0;  ///< NaN where there are none
  std::uint32_t found = 0;
  std::uint32_t shown = 0;  ///< of `contacts`; spread evenly over those found
  std::array<LiveContact, kMostLiveContacts> contacts{};
};

struct LiveTap {
  /// Of ticks: 8 s at 1 kHz.
  hal::Ring<TraceRecord> records{8192};
  hal::Mailbox<LiveTick> ticks;
};

}  // namespace palpate::realtime

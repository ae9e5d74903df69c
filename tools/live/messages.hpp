// SPDX-License-Identifier: GPL-3.0-or-later
// What the live page and the program say to each other: little-endian binary messages. Lengths are
// metres from the view's origin, world axes. The page's half is tools/report/src/live_data.js.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/mock/follower.hpp"
#include "tools/realtime/live_tap.hpp"

namespace palpate::live {

/// Page to program: where the hand wants the tool, or that it lets go. Nothing else is understood.
///   u32 1 · u32 0 · f64 x, y, z (m) · f64 w, x, y, z of the quaternion
///   u32 2 · u32 0
inline constexpr std::size_t kLeadBytes = 64;
inline constexpr std::size_t kLetGoBytes = 8;
/// Farther off nothing is led.
inline constexpr double kFarthest_m = 1e6;

/// Absent for anything but a whole message with these two words, finite numbers, no coordinate
/// beyond kFarthest_m and a quaternion within 1e-3 of unit length, which it is scaled to.
[[nodiscard]] std::optional<hal::mock::Lead> parse_lead(
    std::span<const std::byte> message) noexcept;

/// For tests: what parse_lead() reads.
[[nodiscard]] std::vector<std::byte> encode_lead(const hal::mock::Lead& lead);

/// Bits of Sample::marks.
enum Mark : std::uint32_t { kMissed = 1, kFault = 2, kCutByBudget = 4 };

/// The ticks of a few milliseconds: the largest of each, the last energy, every mark.
struct Sample {
  double t_s = 0;
  float rendered_N = 0;  ///< what the contacts gave
  float sent_N = 0;      ///< after ramps and limits
  float sent_Nm = 0;
  float energy_J = 0;
  float tick_us = 0;
  float late_us = 0;
  std::uint32_t marks = 0;
};

/// All that is not drawn over time.
struct Status {
  bool ended = false;
  realtime::TraceRecord tick;  ///< the newest
  std::uint64_t missed = 0;    ///< periods, so far
  double tick_p50_us = 0, tick_p99_us = 0, tick_max_us = 0, late_p99_us = 0;
};

/// Program to page: kHeadNumbers f64, then 8 f32 a sample, then 8 f32 a contact. Replaces `out`.
/// @param samples   times are written as seconds before the newest tick
/// @param origin_m  of the view
void encode_frame(const Status& status, std::span<const Sample> samples,
                  const realtime::LiveTick& contacts, Vec3d origin_m, std::vector<std::byte>& out);
inline constexpr std::size_t kHeadNumbers = 43;

}  // namespace palpate::live

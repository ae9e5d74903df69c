// SPDX-License-Identifier: GPL-3.0-or-later
// Traces: what each tick of a run did. The file is a TraceHeader, the scene file's path, and
// fixed-size records; docs/REALTIME.md describes every byte. Little-endian.
#pragma once

#include <array>
#include <cstdint>

namespace palpate::realtime {

inline constexpr std::array<char, 8> kTraceMagic{'P', 'A', 'L', 'T', 'R', 'A', 'C', 'E'};
inline constexpr std::uint32_t kTraceVersion = 2;

struct TraceHeader {
  std::array<char, 8> magic = kTraceMagic;
  std::uint32_t version = kTraceVersion;  ///< readers refuse any other
  std::uint32_t record_bytes = 0;         ///< sizeof(TraceRecord)
  std::uint32_t header_bytes =
      0;  ///< where the first record begins: after this, the path, and zeros to a multiple of 8
  std::uint32_t scene_bytes =
      0;  ///< length of the scene file's absolute path (UTF-8, no zero at its end)
  std::uint64_t records = 0;  ///< that follow
  std::uint64_t dropped = 0;  ///< ticks that left no record because the ring was full
  double rate_Hz = 0;
  std::array<std::uint8_t, 16> reserved{};  ///< 0
};
static_assert(sizeof(TraceHeader) == 64);

/// Bits of TraceRecord::truncated.
enum TraceTruncation : std::uint8_t { kByTime = 1, kByUnits = 2, kByMemory = 4 };

/// One tick. World axes, SI units; the torques are about the origin of the tool's body frame.
struct TraceRecord {
  std::uint64_t tick = 0;               ///< counts ticks from 0
  std::uint64_t time_ns = 0;            ///< when the tick was due, since the loop's start
  std::array<double, 3> position_m{};   ///< of the tool
  std::array<double, 4> orientation{};  ///< of the tool, w x y z
  std::array<double, 3>
      rendered_force_N{};  ///< what the contact engine answered; 0 where it was not asked
  std::array<double, 3> rendered_torque_Nm{};
  std::array<float, 3> sent_force_N{};  ///< what the device was sent, after ramps and limits
  std::array<float, 3> sent_torque_Nm{};
  double min_distance_m = 0;  ///< least over contacts; NaN where there are none
  double error_bound_m = 0;   ///< the certificate's
  double s_worst = 0;         ///< the certificate's
  double energy_J = 0;        ///< observed so far, see LoopReport
  std::uint32_t latency_ns =
      0;  ///< wake-up after the time due; the largest number where it does not fit
  std::uint32_t tick_ns = 0;       ///< from wake-up to command sent; likewise
  std::uint32_t state_age_ns = 0;  ///< of the reading that the tick used; likewise
  std::uint32_t contacts = 0;
  std::uint32_t clusters = 0;
  std::uint32_t queries = 0;  ///< convex-pair queries
  std::uint32_t front_nodes = 0;
  std::uint8_t state = 0;      ///< LoopState
  std::uint8_t truncated = 0;  ///< bits of TraceTruncation
  std::uint16_t faults = 0;    ///< FaultSet
  double force_bound_N = 0;    ///< the certificate's
};
static_assert(sizeof(TraceRecord) == 216);

}  // namespace palpate::realtime

// SPDX-License-Identifier: GPL-3.0-or-later
// What pages are shown of a run, out of the loop's tap; and what they may say to it.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "tools/live/messages.hpp"
#include "tools/live/server.hpp"
#include "tools/realtime/histogram.hpp"
#include "tools/realtime/live_tap.hpp"

namespace palpate::live {

/// The strip's length.
inline constexpr double kStrip_s = 5;
/// More would be finer than its pixels.
inline constexpr double kSamples_Hz = 500;

/// Called by the server's thread alone, but for end().
class Feed final : public Source {
 public:
  /// @param tap      outlives this; nobody else reads it
  /// @param start    where the tool is shown before the first tick
  /// @param lead     told where a page wants the tool, in world axes; empty: no page leads. A page
  ///                 that leaves lets go
  Feed(realtime::LiveTap& tap, double rate_Hz, const Pose& start,
       std::function<void(const hal::mock::Lead&)> lead);

  void update() override;
  void frame(std::uint64_t& seen, std::vector<std::byte>& out) const override;
  [[nodiscard]] bool message(std::span<const std::byte> bytes) override;
  void left() override;

  /// The run is over; any thread.
  void end() noexcept { ended_ = true; }

 private:
  void take(const realtime::TraceRecord& record);
  [[nodiscard]] std::uint64_t missed_before(const realtime::TraceRecord& record) const;

  realtime::LiveTap& tap_;
  double rate_Hz_;
  Vec3d origin_m_;
  std::function<void(const hal::mock::Lead&)> lead_;
  std::atomic<bool> ended_{false};
  std::vector<realtime::TraceRecord> batch_;
  Status status_;
  realtime::LiveTick contacts_;
  realtime::Histogram tick_ns_, late_ns_;
  std::uint16_t faults_ = 0;
  std::vector<Sample> strip_;  ///< a ring: sample n is at n modulo its size
  std::uint64_t samples_ = 0;  ///< ever put into it
  std::uint64_t ticks_a_sample_;
  std::uint64_t ticks_in_sample_ = 0;
  Sample sample_;  ///< the next
};

}  // namespace palpate::live

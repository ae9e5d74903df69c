// SPDX-License-Identifier: Apache-2.0
// When a device's reading was taken, on the host's clock.
//
// A packet arrives at least as late as it was sent, so the least of (arrival - device time) over
// the packets is the best guess of the offset between the clocks: the one-sided filter of e.g.
// Paxson, "On calibrating measurements of packet transit times", SIGMETRICS 1998. The guess may
// creep up by kMaxDrift, so that a device clock that runs slow by less is followed; one that is
// worse makes its readings look ever older, until the loop calls them stale.
#pragma once

#include <cstdint>

namespace palpate::hal::protocol {

class ClockMap {
 public:
  /// Of the clocks against each other; crystals keep 1e-4.
  static constexpr double kMaxDrift = 5e-4;

  /// Host time at which a reading was taken, never after its arrival. Called for every reading, in
  /// the order of arrival. The first one is taken to have travelled in no time.
  [[nodiscard]] std::uint64_t host_time(std::uint64_t device_ns,
                                        std::uint64_t arrival_ns) noexcept {
    const auto offset = static_cast<std::int64_t>(arrival_ns - device_ns);
    if (known_) {
      const auto creep =
          static_cast<std::int64_t>(kMaxDrift * static_cast<double>(arrival_ns - last_arrival_ns_));
      offset_ns_ = offset < offset_ns_ + creep ? offset : offset_ns_ + creep;
    } else {
      offset_ns_ = offset;
    }
    known_ = true;
    last_arrival_ns_ = arrival_ns;
    return device_ns + static_cast<std::uint64_t>(offset_ns_);
  }

 private:
  bool known_ = false;
  std::int64_t offset_ns_ = 0;
  std::uint64_t last_arrival_ns_ = 0;
};

}  // namespace palpate::hal::protocol

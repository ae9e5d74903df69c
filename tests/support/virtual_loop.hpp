// SPDX-License-Identifier: GPL-3.0-or-later
// The real-time loop and a mock device in virtual time: time passes only by sleeping and where a
// test lets it.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <utility>
#include <vector>

#include "hal/clock.hpp"
#include "hal/mock/device.hpp"
#include "tools/realtime/loop.hpp"

namespace palpate::realtime::test {

/// Carries a mock device along through time.
class VirtualClock final : public hal::Clock {
 public:
  explicit VirtualClock(hal::mock::MockDevice& device) : device_(device) {}
  std::uint64_t now_ns() noexcept override { return now_ns_; }
  void sleep_until(std::uint64_t time_ns) noexcept override {
    if (time_ns > now_ns_) spend(time_ns - now_ns_);
  }
  void spend(std::uint64_t ns) noexcept {
    now_ns_ += ns;
    if (device_lives_) device_.advance_to(now_ns_);
  }
  /// From now on the device takes no readings any more.
  void kill_device() noexcept { device_lives_ = false; }

 private:
  hal::mock::MockDevice& device_;
  bool device_lives_ = true;
  std::uint64_t now_ns_ = 1'000'000'000;
};

/// A contact query made of a function.
class QueryOf final : public ContactQuery {
 public:
  using Function = std::function<Status(const Pose&, const Budget&, TickResult&)>;
  explicit QueryOf(Function function) : function_(std::move(function)) {}
  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override {
    return function_(tool, budget, out);
  }

 private:
  Function function_;
};

/// The half-space z < 0 as a penalty spring: one contact while the tool's origin is in it.
inline QueryOf::Function wall(double stiffness_N_per_m) {
  return [stiffness_N_per_m](const Pose& tool, const Budget&, TickResult& out) {
    static const Contact kContact;
    out = {};
    if (tool.position_m.z >= 0) return Status::ok;
    out.wrench.force_N.z = -stiffness_N_per_m * tool.position_m.z;
    out.stiffness.add_square({0, 0, 1, 0, 0, 0}, stiffness_N_per_m);
    out.min_distance_m = tool.position_m.z;
    out.contacts = {&kContact, 1};
    out.clusters = 1;
    return Status::ok;
  };
}

/// All that a loop needs, in virtual time.
struct VirtualLoop {
  VirtualLoop(const hal::mock::HandParameters& hand, const LoopSettings& settings,
              QueryOf::Function function, std::size_t ring_capacity = 1u << 14,
              const hal::mock::Options& options = virtual_time(2000))
      : device(hand, options),
        clock(device),
        query(std::move(function)),
        ring(ring_capacity),
        loop(settings, device, query, clock, &ring) {}

  const LoopReport& run() {
    if (device.open() || device.start()) std::abort();
    clock.spend(1);
    loop.run(stop);
    return loop.report();
  }

  std::vector<TraceRecord> records() {
    std::vector<TraceRecord> out(ring.capacity());
    out.resize(ring.pop(out));
    return out;
  }

  static hal::mock::Options virtual_time(double readings_Hz) {
    hal::mock::Options options;
    options.rate_Hz = readings_Hz;
    options.time_base = hal::mock::TimeBase::virtual_;
    return options;
  }

  hal::mock::MockDevice device;
  VirtualClock clock;
  QueryOf query;
  hal::Ring<TraceRecord> ring;
  Loop loop;
  std::atomic<bool> stop{false};
};

}  // namespace palpate::realtime::test

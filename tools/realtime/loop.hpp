// SPDX-License-Identifier: GPL-3.0-or-later
// The real-time loop: newest reading in, contact query, safety stage, command out, once a period.
//
// The loop neither allocates, nor locks, nor logs; its only system calls are the absolute sleep,
// and getrusage twice in a run. It runs on whatever thread and clock it is given, so tests run it
// in virtual time.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

#include "hal/clock.hpp"
#include "hal/device.hpp"
#include "hal/ring.hpp"
#include "tools/realtime/budget_clock.hpp"
#include "tools/realtime/contact_query.hpp"
#include "tools/realtime/histogram.hpp"
#include "tools/realtime/passivity.hpp"
#include "tools/realtime/safety.hpp"
#include "tools/realtime/thread_counters.hpp"
#include "tools/realtime/trace.hpp"

namespace palpate::realtime {

struct LoopSettings {
  double rate_Hz = 1000.0;  ///< 1 to 20000
  std::uint64_t periods =
      std::numeric_limits<std::uint64_t>::max();  ///< the run ends after so many periods, run or
                                                  ///< missed
  QueryTime query_time;                           ///< within the period's share
  /// The contact query ends at this share of the period after the time due, however late the
  /// wake-up was, so that the command leaves in time. The rest is for the tail of the query, which
  /// the budget does not cover, and the command.
  double period_share = 0.8;
  /// Ticks before allocations and page faults count: first uses of code and memory, with no force
  /// rendered.
  std::uint32_t warm_up_ticks = 100;
  /// A command's life: the device goes to zero force by itself this long after the last one.
  double command_life_s = 0.02;
  /// Stands in for the orientation that a device of three axes does not sense; absent: it does.
  std::optional<Quat> fixed_orientation;
  bool passivity_control = false;  ///< energy given out is taken back by a damper (passivity.hpp)
  PassivityController::Limits passivity_limits;
  SafetySettings safety;
};

/// What a run did. Durations in ns.
struct LoopReport {
  std::uint64_t ticks = 0;   ///< run
  std::uint64_t homing = 0;  ///< periods that passed while the device was homing
  std::uint64_t missed = 0;  ///< periods that ended without a command of their own; ticks + missed
                             ///< = periods that passed
  std::uint64_t overrun_ns_max = 0;  ///< the latest command, after its period's end
  Histogram latency;                 ///< wake-up after the time due
  Histogram tick;                    ///< from wake-up to command sent
  Histogram state_age;               ///< of the readings used
  ThreadCounters counted;            ///< after the warm-up
  std::uint64_t queried = 0;         ///< ticks that asked the contact query
  std::uint64_t truncated = 0;       ///< ticks whose refinement the budget ended
  std::uint64_t touching = 0;        ///< ticks with a contact
  std::uint64_t undecided = 0;       ///< ticks with none, in which none was ruled out
  std::uint64_t on_reserve = 0;      ///< ticks that went on for a first contact
  std::uint64_t contacts = 0;        ///< sum over ticks
  double force_N_sum = 0;            ///< sum over ticks of the length of the force sent
  double force_N_max = 0;
  double torque_Nm_max = 0;
  /// Work that the hand has done on the scene, sum of -(F . dx + T . dtheta) with the command in
  /// force between two readings (PassivityController). Where it falls below zero the loop has given
  /// out energy of its own.
  double energy_J = 0;
  double energy_J_min = 0;                    ///< its least value; at most 0
  LoopState state = LoopState::disconnected;  ///< at the end
  FaultSet faults;
  std::array<std::uint64_t, kFaultCount> fault_ticks{};  ///< in which each of them was raised
  std::uint32_t device_faults = 0;                       ///< DeviceFault bits of the readings
  std::array<std::uint64_t, hal::kDeviceFaultKinds> device_fault_ticks{};  ///< likewise
};

class Loop {
 public:
  /// Everything given must outlive the loop. @param telemetry, live  each gets every tick's record;
  /// null: none
  Loop(const LoopSettings& settings, hal::Device& device, ContactQuery& query, hal::Clock& clock,
       hal::Ring<TraceRecord>* telemetry, hal::Ring<TraceRecord>* live = nullptr);

  /// Runs until the periods are over or `stop` becomes true, then sends a last command of zero.
  /// Once. Periods in which the device is homing come on top of those asked for.
  ///
  /// Time. Tick n is due at start + n * period and must have sent its command one period later. A
  /// tick that ends later has missed its deadline; the periods that it ran into are skipped, not
  /// caught up, and the grid of due times stays.
  void run(const std::atomic<bool>& stop) noexcept;

  /// After run().
  [[nodiscard]] const LoopReport& report() const noexcept { return report_; }

  /// Periods that have passed so far, homing left out; any thread.
  [[nodiscard]] std::uint64_t periods_passed() const noexcept {
    return periods_passed_.load(std::memory_order_relaxed);
  }

 private:
  struct Tick;
  std::uint64_t run_tick(std::uint64_t due_ns) noexcept;
  void read_device(Tick& tick) noexcept;
  void query_contacts(Tick& tick) noexcept;
  void send(const Wrench& wrench) noexcept;
  void observe_energy(std::uint64_t elapsed_ns) noexcept;
  void account(const Tick& tick) noexcept;
  void note_faults() noexcept;
  void record(const Tick& tick) noexcept;

  LoopSettings settings_;
  hal::Device& device_;
  ContactQuery& query_;
  hal::Clock& clock_;
  hal::Ring<TraceRecord>* telemetry_;
  hal::Ring<TraceRecord>* live_;
  SafetyStage safety_;
  PassivityController passivity_;
  std::uint64_t period_ns_;
  std::uint64_t start_ns_ = 0;
  hal::DeviceState reading_;    ///< the newest; none yet where its sequence is 0
  hal::DeviceCommand command_;  ///< the last one sent
  Pose pose_before_;            ///< of the reading before
  LoopReport report_;
  std::atomic<std::uint64_t> periods_passed_{0};
};

}  // namespace palpate::realtime

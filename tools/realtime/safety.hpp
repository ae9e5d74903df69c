// SPDX-License-Identifier: GPL-3.0-or-later
// The last stage before the device: a state machine, ramps and limits between the rendered wrench
// and the hand.
//
//   disconnected --first reading--> homing --it knows its zero--> armed --arm_ticks good ticks-->
//   rendering;   any state --a doubt--> fault (left by a new run only)
//
// Force is zero in `disconnected`, `homing` and `armed`, ramps up after entering `rendering`, and
// ramps down to zero after entering `fault`. A device that need not home passes through `homing`
// with its first reading.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "hal/device.hpp"
#include "rt_core/base/status.hpp"

namespace palpate::realtime {

/// The numbers are stable: trace records have them.
enum class LoopState : std::uint8_t {
  disconnected = 0,  ///< no reading has come yet
  armed = 1,         ///< readings and contacts are watched
  rendering = 2,
  fault = 3,
  homing = 4,  ///< between disconnected and armed: the device looks for its zero
};

/// Why force went to zero. The numbers are stable: bits of FaultSet and of trace records.
enum class Fault : std::uint8_t {
  stale_state = 0,       ///< no reading, or none newer than stale_after_s
  bad_state = 1,         ///< a reading with a number that is not finite
  missed_deadlines = 2,  ///< late_ticks_to_fault ticks in a row ended after their deadline
  engine_error = 3,      ///< the contact engine returned an error
  bad_wrench = 4,        ///< the contact engine returned a number that is not finite
  device_error = 5,      ///< the device reported a fault of its own
  not_homed = 6,         ///< the device has not found its zero within home_within_s, or lost it
};
inline constexpr std::uint8_t kFaultCount = 7;

/// Static storage. "stale_state" and so on; "disconnected" and so on.
[[nodiscard]] std::string_view name(Fault fault) noexcept;
[[nodiscard]] std::string_view name(LoopState state) noexcept;

/// A set of faults; bit n is the fault numbered n.
struct FaultSet {
  std::uint16_t bits = 0;
  void add(Fault fault) noexcept {
    bits = static_cast<std::uint16_t>(bits | 1u << static_cast<unsigned>(fault));
  }
  [[nodiscard]] bool has(Fault fault) const noexcept {
    return (bits >> static_cast<unsigned>(fault) & 1u) != 0;
  }
  [[nodiscard]] bool empty() const noexcept { return bits == 0; }
};

/// The names of a set, in the order of their numbers. Allocates: not for the loop.
[[nodiscard]] std::vector<std::string_view> names(FaultSet faults);

struct SafetySettings {
  double max_force_N =
      std::numeric_limits<double>::infinity();  ///< the force is scaled down to this length
  double max_torque_Nm =
      std::numeric_limits<double>::infinity();  ///< the torque is scaled down to this length
  /// The force, as a vector, changes no faster while rendering.
  double max_force_slew_N_per_s = std::numeric_limits<double>::infinity();
  double max_torque_slew_Nm_per_s = std::numeric_limits<double>::infinity();  ///< likewise
  /// The hand is given no more than this; what it spends against the wrench is not limited. Goes
  /// before slew: the wrench falls as fast as it must.
  double max_power_W = std::numeric_limits<double>::infinity();
  double start_ramp_s = 0.2;           ///< full force is reached this long after rendering begins
  std::uint32_t fault_ramp_ticks = 2;  ///< zero is sent with this command after a fault; >= 1
  /// A command that was held for n periods stands for a stiffness that only 1 / n of is stable
  /// (passivity.hpp): what follows is scaled by that, and back to full after this time.
  double hold_recovery_s = 0.05;
  double connect_within_s = 1.0;  ///< the first reading must come this soon
  double home_within_s = 60.0;    ///< homing takes a person
  /// A hand moves 15 mm in this time at 0.3 m/s; longer than the stalls of a host without a
  /// real-time kernel (10 ms seen), so that those are reported as missed deadlines and not as a
  /// lost device.
  double stale_after_s = 0.05;
  std::uint32_t late_ticks_to_fault = 10;  ///< ticks in a row
  std::uint32_t arm_ticks = 100;           ///< good ticks with zero force before rendering
};

/// One call of accept(), command() and tick_ended() each tick, in this order. No allocation, no
/// clock, O(1).
class SafetyStage {
 public:
  SafetyStage(const SafetySettings& settings, double period_s) noexcept;

  /// Judges the newest reading. True where the contact query may use it.
  /// @param reading  null where none has come yet  @param age_s  of the reading
  [[nodiscard]] bool accept(const hal::DeviceState* reading, double age_s) noexcept;

  /// The wrench for the device. @param status, rendered  of the contact query; ignored where
  /// accept() was false  @param twist  of the tool, as last observed
  [[nodiscard]] Wrench command(Status status, const Wrench& rendered,
                               const hal::Twist& twist) noexcept;

  /// Told once the tick's command is out. @param missed  periods that ended in the meantime,
  /// without a command of their own; 0 where the tick met its deadline
  void tick_ended(std::uint64_t missed) noexcept;

  [[nodiscard]] LoopState state() const noexcept { return state_; }
  [[nodiscard]] FaultSet faults() const noexcept { return faults_; }

 private:
  [[nodiscard]] Wrench within_limits(const Wrench& rendered,
                                     const hal::Twist& twist) const noexcept;
  void judge(const hal::DeviceState& reading, double age_s) noexcept;
  void follow_homing(bool homing) noexcept;
  void raise(Fault fault) noexcept;
  void enter(LoopState state) noexcept;
  [[nodiscard]] double seconds(std::uint64_t ticks) const noexcept;

  SafetySettings settings_;
  double period_s_;
  LoopState state_ = LoopState::disconnected;
  FaultSet faults_;
  bool accepted_ = false;
  std::uint64_t ticks_in_state_ = 0;
  std::uint64_t commands_in_fault_ = 0;
  std::uint32_t late_in_a_row_ = 0;
  double held_gain_ = 1;  ///< 1 / n after a command was held for n periods, rising to 1
  Wrench sent_;           ///< the last command; what a fault ramps down from
  Wrench sent_at_fault_;
};

}  // namespace palpate::realtime

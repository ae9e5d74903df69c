// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/safety.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::realtime {
namespace {

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool is_finite(const Wrench& w) { return is_finite(w.force_N) && is_finite(w.torque_Nm); }
bool is_finite(const Pose& p) {
  const Quat& q = p.orientation;
  return is_finite(p.position_m) && std::isfinite(q.w) && std::isfinite(q.x) &&
         std::isfinite(q.y) && std::isfinite(q.z);
}

Wrench scaled(double gain, const Wrench& w) { return {gain * w.force_N, gain * w.torque_Nm}; }

/// Shortened to a length; rounding must not carry it past the limit by a last digit.
Vec3d limited(const Vec3d& v, double max_length) {
  constexpr double kJustBelowOne = 1 - 4 * std::numeric_limits<double>::epsilon();
  const double length = norm(v);
  return length > max_length ? (kJustBelowOne * max_length / length) * v : v;
}

/// From one value towards another, no farther than a step.
Vec3d stepped(const Vec3d& from, const Vec3d& to, double max_step) {
  const Vec3d change = limited(to - from, max_step);
  // Added up where it is cut only: a wrench within the rate is sent to its last bit.
  return change == to - from ? to : from + change;
}

/// Scaled down until the hand is given no more than this.
Wrench within_power(const Wrench& w, const hal::Twist& twist, double max_W) {
  const double given_W =
      dot(w.force_N, twist.linear_m_per_s) + dot(w.torque_Nm, twist.angular_rad_per_s);
  return given_W > max_W ? scaled(max_W / given_W, w) : w;
}

/// How far a ramp has come after a time, in [0, 1]; a ramp of no length is over at once.
double ramp(double elapsed_s, double length_s) {
  return elapsed_s >= length_s ? 1.0 : elapsed_s / length_s;
}

/// An overheated device still works, with less force: a limit, not a fault.
constexpr std::uint32_t kHarmless = hal::kDeviceOverheated;

}  // namespace

std::string_view name(Fault fault) noexcept {
  switch (fault) {
    case Fault::stale_state:
      return "stale_state";
    case Fault::bad_state:
      return "bad_state";
    case Fault::missed_deadlines:
      return "missed_deadlines";
    case Fault::engine_error:
      return "engine_error";
    case Fault::bad_wrench:
      return "bad_wrench";
    case Fault::device_error:
      return "device_error";
    case Fault::not_homed:
      return "not_homed";
  }
  return "unknown";
}

std::string_view name(LoopState state) noexcept {
  switch (state) {
    case LoopState::disconnected:
      return "disconnected";
    case LoopState::armed:
      return "armed";
    case LoopState::rendering:
      return "rendering";
    case LoopState::fault:
      return "fault";
    case LoopState::homing:
      return "homing";
  }
  return "unknown";
}

std::vector<std::string_view> names(FaultSet faults) {
  std::vector<std::string_view> out;
  for (std::uint8_t i = 0; i < kFaultCount; ++i) {
    if (faults.has(Fault{i})) out.push_back(name(Fault{i}));
  }
  return out;
}

SafetyStage::SafetyStage(const SafetySettings& settings, double period_s) noexcept
    : settings_(settings), period_s_(period_s) {}

bool SafetyStage::accept(const hal::DeviceState* reading, double age_s) noexcept {
  ++ticks_in_state_;
  accepted_ = false;
  if (reading == nullptr) {
    if (seconds(ticks_in_state_) > settings_.connect_within_s) raise(Fault::stale_state);
    return false;
  }
  judge(*reading, age_s);
  accepted_ = state_ == LoopState::armed || state_ == LoopState::rendering;
  return accepted_;
}

void SafetyStage::judge(const hal::DeviceState& reading, double age_s) noexcept {
  if (state_ == LoopState::disconnected) enter(LoopState::homing);
  if (age_s > settings_.stale_after_s) raise(Fault::stale_state);
  if (!is_finite(reading.pose)) raise(Fault::bad_state);
  if ((reading.faults & ~kHarmless) != 0) raise(Fault::device_error);
  follow_homing(reading.homing);
}

void SafetyStage::follow_homing(bool homing) noexcept {
  if (state_ == LoopState::homing && !homing) {
    enter(LoopState::armed);
  } else if (state_ == LoopState::homing) {
    if (seconds(ticks_in_state_) > settings_.home_within_s) raise(Fault::not_homed);
  } else if (homing) {
    raise(Fault::not_homed);  // its coordinates are about to jump
  }
}

Wrench SafetyStage::command(Status status, const Wrench& rendered,
                            const hal::Twist& twist) noexcept {
  if (accepted_ && status != Status::ok) {
    raise(Fault::engine_error);
  } else if (accepted_ && !is_finite(rendered)) {
    raise(Fault::bad_wrench);
  }
  if (state_ == LoopState::rendering) {
    sent_ = within_limits(rendered, twist);
  } else if (state_ == LoopState::fault) {
    const double most = settings_.fault_ramp_ticks;
    sent_ = scaled(1.0 - ramp(static_cast<double>(++commands_in_fault_), most), sent_at_fault_);
  } else {
    sent_ = {};
    if (state_ == LoopState::armed && ticks_in_state_ > settings_.arm_ticks) {
      enter(LoopState::rendering);
    }
  }
  return sent_;
}

Wrench SafetyStage::within_limits(const Wrench& rendered, const hal::Twist& twist) const noexcept {
  const Wrench within{limited(rendered.force_N, settings_.max_force_N),
                      limited(rendered.torque_Nm, settings_.max_torque_Nm)};
  // Limits before the ramp: a deep start rises as gently as a shallow one. What follows keeps them:
  // a gain is at most 1, and a step leads from one vector within a length towards another.
  const double gain = held_gain_ * ramp(seconds(ticks_in_state_), settings_.start_ramp_s);
  const Wrench ramped = scaled(gain, within);
  const Wrench stepped_to{
      stepped(sent_.force_N, ramped.force_N, settings_.max_force_slew_N_per_s * period_s_),
      stepped(sent_.torque_Nm, ramped.torque_Nm, settings_.max_torque_slew_Nm_per_s * period_s_)};
  return within_power(stepped_to, twist, settings_.max_power_W);
}

void SafetyStage::tick_ended(std::uint64_t missed) noexcept {
  held_gain_ = missed > 0 ? std::min(held_gain_, 1 / static_cast<double>(1 + missed))
                          : std::min(1.0, held_gain_ + ramp(period_s_, settings_.hold_recovery_s));
  late_in_a_row_ = missed > 0 ? late_in_a_row_ + 1 : 0;
  if (late_in_a_row_ >= settings_.late_ticks_to_fault) raise(Fault::missed_deadlines);
}

double SafetyStage::seconds(std::uint64_t ticks) const noexcept {
  return static_cast<double>(ticks) * period_s_;
}

void SafetyStage::raise(Fault fault) noexcept {
  faults_.add(fault);
  if (state_ == LoopState::fault) return;
  sent_at_fault_ = sent_;
  enter(LoopState::fault);
}

void SafetyStage::enter(LoopState state) noexcept {
  state_ = state;
  ticks_in_state_ = 0;
}

}  // namespace palpate::realtime

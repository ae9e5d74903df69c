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
  if (age_s > settings_.stale_after_s) raise(Fault::stale_state);
  if (!is_finite(reading->pose)) raise(Fault::bad_state);
  if ((reading->faults & ~kHarmless) != 0) raise(Fault::device_error);
  if (state_ == LoopState::disconnected) enter(LoopState::armed);
  accepted_ = state_ != LoopState::fault;
  return accepted_;
}

Wrench SafetyStage::command(Status status, const Wrench& rendered) noexcept {
  if (accepted_ && status != Status::ok) {
    raise(Fault::engine_error);
  } else if (accepted_ && !is_finite(rendered)) {
    raise(Fault::bad_wrench);
  }
  sent_ = {};
  if (state_ == LoopState::armed && ticks_in_state_ > settings_.arm_ticks) {
    enter(LoopState::rendering);
  } else if (state_ == LoopState::rendering) {
    // Limits before the ramp: a deep start rises as gently as a shallow one, and a gain of at most
    // 1 keeps the limits.
    const Wrench within{limited(rendered.force_N, settings_.max_force_N),
                        limited(rendered.torque_Nm, settings_.max_torque_Nm)};
    sent_ = scaled(ramp(seconds(ticks_in_state_), settings_.start_ramp_s), within);
  } else if (state_ == LoopState::fault) {
    ++commands_in_fault_;
    sent_ = scaled(1.0 - ramp(seconds(commands_in_fault_), settings_.fault_ramp_s), sent_at_fault_);
  }
  return sent_;
}

void SafetyStage::tick_ended(bool late) noexcept {
  late_in_a_row_ = late ? late_in_a_row_ + 1 : 0;
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

// SPDX-License-Identifier: Apache-2.0
#include "hal/mock/device.hpp"

#include <pthread.h>
#include <sched.h>

#include <cmath>
#include <utility>

namespace palpate::hal::mock {
namespace {

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Shortened to a length; what a motor's limit does.
Vec3d limited(Vec3d v, double max_length) {
  const double length = norm(v);
  return length > max_length ? (max_length / length) * v : v;
}

}  // namespace

MockDevice::MockDevice(HandParameters hand, const Options& options)
    : options_(options), parameters_(std::move(hand)) {
  if (!capabilities().renders_torque()) options_.max_torque_Nm = 0;
}

MockDevice::~MockDevice() { stop(); }

Capabilities MockDevice::capabilities() const noexcept {
  Capabilities c;
  c.max_force_N = options_.max_force_N;
  c.max_torque_Nm = options_.max_torque_Nm;
  c.rate_Hz = options_.rate_Hz;
  c.sensed_dof = options_.sensed_dof;
  c.rendered_dof = options_.rendered_dof;
  c.senses_twist = true;
  return c;
}

std::optional<DeviceProblem> MockDevice::open() {
  const double dt_s = 1.0 / options_.rate_Hz;
  if (const char* why = why_refused(parameters_, dt_s)) {
    return DeviceProblem{"open", why, "change the mock hand's parameters"};
  }
  period_ns_ = static_cast<std::uint64_t>(std::llround(1e9 * dt_s));
  hand_.emplace(parameters_, dt_s);
  if (options_.led) follower_.emplace(*options_.led, hand_->pose());
  next_ns_ = 0;
  sequence_ = 0;
  command_ = {};
  faults_ = kNoDeviceFault;
  script_ = Faults(options_.faults, options_.fault_seed);
  line_.clear();
  unplugged_ = false;
  return std::nullopt;
}

std::optional<DeviceProblem> MockDevice::start() {
  if (!hand_) return DeviceProblem{"start", "the device is not open", "open it first"};
  if (options_.time_base == TimeBase::real && !thread_.joinable()) {
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
  }
  return std::nullopt;
}

void MockDevice::stop() noexcept {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void MockDevice::advance_to(std::uint64_t time_ns) noexcept {
  if (next_ns_ == 0) begin_at(time_ns);
  while (next_ns_ <= time_ns) period(next_ns_);
}

void MockDevice::run() noexcept {
  if (options_.fifo_priority > 0) {
    sched_param parameter{};
    parameter.sched_priority = options_.fifo_priority;
    // Refused without the right to it; the simulated hand then merely keeps worse time.
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  }
  MonotonicClock clock;
  begin_at(clock.now_ns());
  while (!stopping_.load(std::memory_order_relaxed)) {
    clock.sleep_until(next_ns_);
    advance_to(clock.now_ns());
  }
}

void MockDevice::begin_at(std::uint64_t time_ns) noexcept {
  zero_ns_ = time_ns;
  next_ns_ = time_ns + period_ns_;
  publish(time_ns);
}

void MockDevice::period(std::uint64_t time_ns) noexcept {
  advance_hand(wrench_in_force(time_ns));
  next_ns_ += period_ns_;
  publish(time_ns);
}

void MockDevice::advance_hand(const Wrench& wrench) noexcept {
  if (!follower_) return hand_->advance(wrench);
  Lead lead;
  if (leads_.read(lead)) follower_->lead(lead);
  hand_->advance(wrench, follower_->advance(hand_->pose(), 1 / options_.rate_Hz));
}

void MockDevice::publish(std::uint64_t time_ns) noexcept {
  DeviceState state;
  state.sequence = ++sequence_;
  state.time_ns = time_ns;
  state.homing = is_homing(time_ns);
  if (!state.homing) {
    state.pose = hand_->pose();
    state.twist = hand_->twist();
  }
  if (!capabilities().senses_orientation()) {
    state.pose.orientation = {};
    state.twist.angular_rad_per_s = {};
  }
  state.faults = faults();
  if (options_.faults.empty()) {
    states_.write(state);
  } else {
    publish_faulty(state);
  }
}

void MockDevice::publish_faulty(DeviceState state) noexcept {
  const std::uint64_t now_ns = state.time_ns;
  const double t_s = seconds(now_ns);
  const bool was_unplugged = unplugged_;
  unplugged_ = script_.hit(FaultKind::unplug, t_s) != nullptr;
  if (unplugged_) {
    line_.clear();
    if (was_unplugged) return;
    faults_.fetch_or(kDeviceLost, std::memory_order_relaxed);
    state.faults = faults();
    states_.write(state);
    return;
  }
  if (script_.hit(FaultKind::stuck, t_s) == nullptr) stuck_at_ = state.pose;
  state.pose = stuck_at_;
  if (script_.hit(FaultKind::nan, t_s) != nullptr) state.pose.position_m.x = std::nan("");
  const double ahead_ns = 1e9 * script_.clock_error_s(t_s);
  state.time_ns += static_cast<std::uint64_t>(std::llround(ahead_ns));
  const bool refused = script_.hit(FaultKind::truncate, t_s) != nullptr ||
                       script_.hit(FaultKind::corrupt, t_s) != nullptr;
  if (!refused) line_.push(state, t_s, now_ns, script_);
  while (const auto arrived = line_.pop(now_ns)) states_.write(*arrived);
}

double MockDevice::seconds(std::uint64_t time_ns) const noexcept {
  return 1e-9 * static_cast<double>(time_ns - zero_ns_);
}

bool MockDevice::is_homing(std::uint64_t time_ns) const noexcept {
  return seconds(time_ns) < options_.homing_s;
}

Wrench MockDevice::wrench_in_force(std::uint64_t time_ns) noexcept {
  // The commands' mailbox keeps its own copy; an unchanged one is judged by its expiry again in
  // each period.
  static_cast<void>(commands_.read(command_));
  const Wrench& wrench = command_.wrench;
  if (!is_finite(wrench.force_N) || !is_finite(wrench.torque_Nm)) {
    faults_.fetch_or(kDeviceBadCommand, std::memory_order_relaxed);
    return {};
  }
  if (time_ns >= command_.expires_ns || unplugged_ || is_homing(time_ns)) return {};
  return {limited(wrench.force_N, options_.max_force_N),
          limited(wrench.torque_Nm, options_.max_torque_Nm)};
}

}  // namespace palpate::hal::mock

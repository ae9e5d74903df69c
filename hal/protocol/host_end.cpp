// SPDX-License-Identifier: Apache-2.0
#include "hal/protocol/host_end.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::hal::protocol {
namespace {

constexpr double kMicro = 1e6;
constexpr double kNanometres = 1e9;
constexpr std::uint64_t kNsPerUs = 1000;

Vec3d metres(const std::array<std::int32_t, 3>& nm) {
  return {nm[0] / kNanometres, nm[1] / kNanometres, nm[2] / kNanometres};
}

Quat unit_quaternion(const std::array<std::int32_t, 4>& q) {
  double squared = 0;
  for (const std::int32_t c : q) squared += static_cast<double>(c) * c;
  const double scale = 1.0 / std::sqrt(squared);
  return {scale * q[0], scale * q[1], scale * q[2], scale * q[3]};
}

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// A finite number in millionths, cut to the range of the wire.
std::int32_t micro(double value) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::clamp(std::round(kMicro * value), -kMost, kMost));
}

std::array<std::int32_t, 3> micro(const Vec3d& v) { return {micro(v.x), micro(v.y), micro(v.z)}; }

std::uint32_t faults_of(const State& s) {
  std::uint32_t faults = kNoDeviceFault;
  if ((s.health & kOverheated) != 0) faults |= kDeviceOverheated;
  if ((s.health & kBadSensor) != 0) faults |= kDeviceBadReading;
  if ((s.health & kMotorFailure) != 0 || s.mode == Mode::fault) faults |= kDeviceFailed;
  if (s.mode == Mode::expired) faults |= kDeviceSilenced;
  return faults;
}

}  // namespace

void Obedience::judge(const State& reading, std::uint64_t time_ns,
                      std::uint64_t arrival_ns) noexcept {
  const bool has_taken_more = reading.answered != 0 && is_after(reading.answered, answered_) &&
                              !is_after(reading.answered, asked_);
  const bool takes = reading.answered == asked_ || has_taken_more;
  answered_ = reading.answered;
  // The other modes say themselves why there is no force.
  const bool may_render = reading.mode == Mode::active || reading.mode == Mode::idle;
  if (!asking_ || !may_render) return;
  if (takes && reading.mode == Mode::active) {
    waiting_ = false;
    refused_ = reading.refused;
  } else if (!waiting_) {
    waiting_ = true;
    since_ns_ = arrival_ns;
  } else if (fault_ == kNoDeviceFault && time_ns > since_ns_ + kWithin_ns) {
    fault_ = reading.refused != refused_ ? kDeviceRefuses : takes ? kDeviceIdle : kDeviceIgnores;
  }
}

bool HostEnd::receive(std::span<const std::byte> packet, std::uint64_t arrival_ns,
                      DeviceState& out) noexcept {
  State s;
  if (decode(packet, s) != PacketError::none || s.is_joint_state != (chain_.joints() > 0) ||
      s.sequence == 0) {
    ++counters_.refused;
    return false;
  }
  const bool first = last_sequence_ == 0;
  if (!first && (!is_after(s.sequence, last_sequence_) || s.device_time_ns <= last_device_ns_)) {
    ++counters_.outdated;
    return false;
  }
  const std::uint32_t steps = first ? 1 : s.sequence - last_sequence_;
  counters_.lost += steps - 1;
  ++counters_.readings;
  sequence_ += steps;
  last_sequence_ = s.sequence;
  last_device_ns_ = s.device_time_ns;
  const std::uint64_t time_ns = clock_map_.host_time(s.device_time_ns, arrival_ns);

  out = {};
  out.sequence = sequence_;
  out.time_ns = time_ns;
  out.buttons = s.buttons;
  obedience_.judge(s, time_ns, arrival_ns);
  out.faults = faults_of(s) | obedience_.fault();
  homing_ = out.homing = s.mode == Mode::homing;
  if (homing_) return true;
  out.pose = s.is_joint_state ? chain_.pose(s.joint_counts)
                              : Pose{metres(s.position_nm), unit_quaternion(s.orientation)};
  if (!chain_.is_within_ends(s.joint_counts)) out.faults |= kDeviceBadReading;
  counts_ = s.joint_counts;
  return true;
}

Packet HostEnd::command(const DeviceCommand& command, std::uint64_t now_ns) noexcept {
  const bool in_force = !homing_ && now_ns < command.expires_ns &&
                        is_finite(command.wrench.force_N) && is_finite(command.wrench.torque_Nm);
  const std::uint64_t left_us = in_force ? (command.expires_ns - now_ns) / kNsPerUs : 0;
  if (left_us == 0) return no_force();
  Command c;
  c.sequence = ++commands_;
  obedience_.asked(c.sequence);
  c.life_us =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(left_us, capabilities_.max_life_us));
  c.enable = true;
  c.is_joint_command = chain_.joints() > 0;
  if (c.is_joint_command) {
    const JointTorques torques_Nm = chain_.torques(counts_, command.wrench);
    std::transform(torques_Nm.begin(), torques_Nm.end(), c.joint_torque_uNm.begin(),
                   [](double torque_Nm) { return micro(torque_Nm); });
  } else {
    c.force_uN = micro(command.wrench.force_N);
    c.torque_uNm = micro(command.wrench.torque_Nm);
  }
  // Back on the wire's count, where 0 is "none" and the very first commands have none to name.
  const std::uint64_t readings_since = sequence_ - std::min(sequence_, command.answers);
  c.answers =
      command.answers == 0 ? 0 : last_sequence_ - static_cast<std::uint32_t>(readings_since);
  const std::uint64_t age_us = (now_ns - std::min(now_ns, command.state_time_ns)) / kNsPerUs;
  c.state_age_us = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(age_us, std::numeric_limits<std::uint32_t>::max()));
  return encode(c);
}

Packet HostEnd::no_force() noexcept {
  obedience_.released();
  Command c;
  c.is_joint_command = chain_.joints() > 0;
  c.sequence = ++commands_;
  c.life_us = 1;
  return encode(c);
}

}  // namespace palpate::hal::protocol

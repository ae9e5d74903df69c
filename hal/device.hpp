// SPDX-License-Identifier: Apache-2.0
// The device interface: what the real-time loop knows of a haptic device, whatever bus it hangs on.
//
// Threads. One control thread calls open(), start() and stop(). One real-time thread calls
// receive() and send() between start() and stop(); both are wait-free, never allocate, never make a
// system call. Whatever the bus needs (polling, transfers) happens on a thread of the device's own,
// which keeps the device safe by itself: a command is in force until `expires_ns`, afterwards the
// device renders no force, whoever has died on the host.
//
// World axes throughout: the device's base frame is the scene's world frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rt_core/geometry/pose.hpp"

namespace palpate::hal {

/// Rates of change of a pose: velocity of the origin and angular velocity, in world axes.
struct Twist {
  Vec3d linear_m_per_s{};
  Vec3d angular_rad_per_s{};
};

/// What the device itself says about its health. A set of bits; numbers are stable: they are only
/// ever added to.
enum DeviceFault : std::uint32_t {
  kNoDeviceFault = 0,
  kDeviceLost = 1u << 0,  ///< unplugged, or the bus failed
  kDeviceBadCommand =
      1u << 1,  ///< it was sent a command that is not finite; it rendered none of it
  kDeviceOverheated = 1u << 2,  ///< it has reduced its force to protect itself
  kDeviceBadReading = 1u << 3,  ///< a sensor's reading cannot be right
  kDeviceFailed = 1u << 4,      ///< a motor, its power, or the device's own checks
  kDeviceSilenced = 1u << 5,  ///< the force was ended because commands came too late or were stale
  kDeviceRefuses = 1u << 6,   ///< it refuses the commands that it is sent
  kDeviceIgnores = 1u << 7,   ///< it neither takes nor refuses them
  kDeviceIdle = 1u << 8,      ///< it takes them, and renders no force
};

inline constexpr std::uint8_t kDeviceFaultKinds = 9;

/// One reading of the device.
struct DeviceState {
  std::uint64_t sequence = 0;  ///< counts readings from 1; a gap is a lost reading
  std::uint64_t time_ns = 0;   ///< when the reading was taken, on the host's monotonic clock
  Pose pose;                   ///< of the tool: body to world
  Twist twist;                 ///< of the tool; meaningful where Capabilities::senses_twist
  std::uint32_t buttons = 0;   ///< a bit a button, 1 = pressed
  std::uint32_t faults = 0;    ///< bits of DeviceFault that hold now
  /// The device does not know its zero yet: it renders no force, and the pose means nothing.
  bool homing = false;
};

/// What the device is asked to render.
struct DeviceCommand {
  std::uint64_t sequence = 0;  ///< counts commands from 1
  std::uint64_t time_ns = 0;   ///< when it was computed, on the host's monotonic clock
  std::uint64_t expires_ns =
      0;          ///< from this time on the device renders zero, unless a newer command has come
  Wrench wrench;  ///< on the tool, about the origin of its body frame
  std::uint64_t answers =
      0;  ///< DeviceState::sequence of the reading it was computed from; 0: none
  std::uint64_t state_time_ns = 0;  ///< DeviceState::time_ns of that reading
};

/// What the device can do.
struct Capabilities {
  double max_force_N = 0;         ///< peak, in any direction
  double max_torque_Nm = 0;       ///< peak, about any axis; 0 where it renders no torque
  double rate_Hz = 0;             ///< readings a second; commands are taken as often
  std::uint8_t sensed_dof = 6;    ///< 3: position only, 6: position and orientation
  std::uint8_t rendered_dof = 6;  ///< 3: force only, 6: force and torque
  bool senses_twist = false;

  [[nodiscard]] bool senses_orientation() const noexcept { return sensed_dof > 3; }
  [[nodiscard]] bool renders_torque() const noexcept { return rendered_dof > 3; }
};

/// Why a device could not be used: in which phase, the likely cause, and the fix.
struct DeviceProblem {
  std::string phase;
  std::string cause;
  std::string fix;
};

class Device {
 public:
  virtual ~Device() = default;
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  Device(Device&&) = delete;
  Device& operator=(Device&&) = delete;

  /// Valid after a successful open().
  [[nodiscard]] virtual Capabilities capabilities() const noexcept = 0;

  /// Reaches the device and readies it; no force yet. May block and allocate. The problem where it
  /// cannot.
  [[nodiscard]] virtual std::optional<DeviceProblem> open() = 0;

  /// Begins the exchange. May block and allocate. Readings arrive soon after, those of a device
  /// that is homing too. The problem where it cannot.
  [[nodiscard]] virtual std::optional<DeviceProblem> start() = 0;

  /// Takes the newest reading. True where it is newer than the one last taken; else `out` is left
  /// as it is. Wait-free.
  [[nodiscard]] virtual bool receive(DeviceState& out) noexcept = 0;

  /// Hands over the newest command; one not yet taken by the device is replaced. Wait-free.
  virtual void send(const DeviceCommand& command) noexcept = 0;

  /// Ends the exchange with no force rendered. Harmless when not started.
  virtual void stop() noexcept = 0;

  /// Every DeviceFault seen since start(). Wait-free, any thread.
  [[nodiscard]] virtual std::uint32_t faults() const noexcept = 0;
};

}  // namespace palpate::hal

// SPDX-License-Identifier: Apache-2.0
// The driver of the Novint Falcon: three axes of position and force, four buttons.
//
// The device answers one request at a time, so that its rate is the round trip's, about 1 kHz.
// It is homing until all three arms have found their zero (the user pulls the grip all the way out
// and pushes it in again); until then the motors are off. World axes: x right, y up, z towards the
// user; origin in the middle of the workspace.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/falcon/messages.hpp"
#include "hal/transport/driver.hpp"

namespace palpate::hal::falcon {

/// The world's origin in the frame of kinematics.hpp.
inline constexpr Vec3d kMiddle_m{0, 0, 0.12};

class FalconDriver final : public Driver {
 public:
  /// @param firmware  bytes of the maker's file; empty: the device must be running already
  explicit FalconDriver(std::vector<std::byte> firmware) : firmware_(std::move(firmware)) {}

  [[nodiscard]] std::optional<DeviceProblem> bring_up(Transport& transport) override;
  [[nodiscard]] Capabilities capabilities() const noexcept override;
  [[nodiscard]] std::optional<DeviceProblem> begin(Transport& transport) override;
  [[nodiscard]] bool received(std::span<const std::byte> bytes, std::uint64_t now_ns,
                              DeviceState& out) noexcept override;
  [[nodiscard]] std::size_t poll(const DeviceCommand& command, bool fresh, std::uint64_t now_ns,
                                 OutBuffer& out) noexcept override;
  [[nodiscard]] std::size_t farewell(OutBuffer& out) noexcept override;
  void end(Transport& transport) noexcept override;
  [[nodiscard]] std::uint32_t faults(std::uint64_t now_ns) const noexcept override;
  [[nodiscard]] double first_reading_within_s() const noexcept override;
  [[nodiscard]] DeviceProblem why_no_reading() const override;

 private:
  [[nodiscard]] bool take(const Reply& reply, DeviceState& out) noexcept;
  [[nodiscard]] MotorValues motors_for(const Wrench& wrench) const noexcept;

  std::vector<std::byte> firmware_;
  ReplyParser parser_;
  bool awaiting_ = false;  ///< a request is under way
  std::uint64_t sent_ns_ = 0;
  std::uint32_t silent_requests_ = 0;  ///< in a row
  std::uint64_t sequence_ = 0;
  bool replied_ = false;          ///< since begin()
  bool homed_ = false;            ///< in the newest reply
  bool lost_its_zero_ = false;    ///< homed, then not
  std::uint32_t bad_counts_ = 0;  ///< replies in a row that no pose belongs to
  bool posed_ = false;            ///< theta_ and position_ are the newest reply's
  JointAngles theta_{};
  Vec3d position_m_;
};

}  // namespace palpate::hal::falcon

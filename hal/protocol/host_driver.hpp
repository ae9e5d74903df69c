// SPDX-License-Identifier: Apache-2.0
// The driver of devices that speak the open protocol (docs/PROTOCOL.md).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hal/protocol/host_end.hpp"
#include "hal/protocol/packets.hpp"
#include "hal/transport/driver.hpp"

namespace palpate::hal::protocol {

/// A control request for one of the descriptors, and its packet. What went wrong, as a sentence,
/// where there is none.
template <class Descriptor>
[[nodiscard]] std::optional<DeviceProblem> read_descriptor(Transport& transport, PacketType type,
                                                           std::uint8_t index, Descriptor& out);

/// An image's content_sha256 (docs/FORMAT.md).
using ImageHash = std::array<std::uint8_t, 32>;

class HostDriver final : public Driver {
 public:
  /// @param images  of the scene: a device that uses another one is refused at bring_up(), for what
  /// it computes by itself would be of other bodies. One that holds none is not. Empty: not asked.
  explicit HostDriver(std::vector<ImageHash> images = {}) : images_(std::move(images)) {}

  [[nodiscard]] std::optional<DeviceProblem> bring_up(Transport& transport) override;
  [[nodiscard]] hal::Capabilities capabilities() const noexcept override;
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

  [[nodiscard]] const LinkCounters& counters() const noexcept { return end_.counters(); }

 private:
  [[nodiscard]] std::optional<DeviceProblem> check_image(Transport& transport) const;

  std::vector<ImageHash> images_;
  Capabilities capabilities_;
  SerialChain chain_;
  HostEnd end_{capabilities_};
  std::uint64_t last_no_force_ns_ = 0;
  bool enabled_ = false;  ///< the last packet sent asked for a force
};

extern template std::optional<DeviceProblem> read_descriptor(Transport&, PacketType, std::uint8_t,
                                                             Capabilities&);
extern template std::optional<DeviceProblem> read_descriptor(Transport&, PacketType, std::uint8_t,
                                                             Joint&);
extern template std::optional<DeviceProblem> read_descriptor(Transport&, PacketType, std::uint8_t,
                                                             ImageIdentity&);

}  // namespace palpate::hal::protocol

// SPDX-License-Identifier: Apache-2.0
#include "hal/protocol/host_driver.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>

namespace palpate::hal::protocol {
namespace {

constexpr std::uint32_t kControlTimeout_ms = 500;
constexpr double kMicro = 1e-6;
/// While nobody wants a force the device is told so again and again: one such packet may be lost.
constexpr std::uint64_t kNoForceEvery_ns = 10'000'000;
constexpr double kFirstReadingWithin_s = 2.0;

std::size_t copy(const Packet& packet, OutBuffer& out) noexcept {
  static_assert(kPacketBytes <= kMaxOutBytes);
  std::copy(packet.begin(), packet.end(), out.begin());
  return packet.size();
}

}  // namespace

template <class Descriptor>
std::optional<DeviceProblem> read_descriptor(Transport& transport, PacketType type,
                                             std::uint8_t index, Descriptor& out) {
  const auto value = static_cast<std::uint16_t>(static_cast<unsigned>(type) << 8 | index);
  const ControlRequest request{kVendorIn, static_cast<std::uint8_t>(Request::read), value,
                               transport.interface_number()};
  Packet packet{};
  const IoResult result = transport.control_in(request, packet, kControlTimeout_ms);
  if (!result.ok()) {
    return DeviceProblem{"descriptors", describe(result.status),
                         "plug the device in again; if it stays, its firmware does not follow "
                         "docs/PROTOCOL.md"};
  }
  const PacketError error = decode(std::span(packet).first(result.bytes), out);
  if (error == PacketError::none) return std::nullopt;
  if (error == PacketError::version) {
    return DeviceProblem{"descriptors",
                         "the device speaks version " +
                             std::to_string(std::to_integer<unsigned>(packet[2])) +
                             " of the protocol, this host version " + std::to_string(kVersion),
                         "update the older of the two"};
  }
  return DeviceProblem{"descriptors", std::string("its answer is refused, ") + describe(error),
                       "update the device's firmware"};
}

template std::optional<DeviceProblem> read_descriptor(Transport&, PacketType, std::uint8_t,
                                                      Capabilities&);
template std::optional<DeviceProblem> read_descriptor(Transport&, PacketType, std::uint8_t, Joint&);
template std::optional<DeviceProblem> read_descriptor(Transport&, PacketType, std::uint8_t,
                                                      ImageIdentity&);

std::optional<DeviceProblem> HostDriver::bring_up(Transport& transport) {
  if (auto problem = read_descriptor(transport, PacketType::capabilities, 0, capabilities_)) {
    return problem;
  }
  if (auto problem = check_image(transport)) return problem;
  std::array<Joint, kMaxJoints> joints{};
  for (std::uint8_t i = 0; i < capabilities_.joints; ++i) {
    if (auto problem = read_descriptor(transport, PacketType::joint, i, joints[i])) return problem;
    if (joints[i].index != i) {
      return DeviceProblem{"descriptors", "it describes another joint than it was asked for",
                           "update the device's firmware"};
    }
  }
  chain_ = SerialChain(std::span(joints).first(capabilities_.joints));
  return std::nullopt;
}

std::optional<DeviceProblem> HostDriver::check_image(Transport& transport) const {
  if (images_.empty() || capabilities_.slots == 0) return std::nullopt;
  ImageIdentity held;
  if (auto problem = read_descriptor(transport, PacketType::image_identity, 0, held)) {
    return problem;
  }
  const bool is_known =
      std::find(images_.begin(), images_.end(), held.content_sha256) != images_.end();
  if (held.active_slot == kNoSlot || is_known) return std::nullopt;
  return DeviceProblem{"image identity", "the device uses an image that is not of this scene",
                       "give it one of the scene's: palpate flash IMAGE --device usb"};
}

hal::Capabilities HostDriver::capabilities() const noexcept {
  hal::Capabilities c;
  c.max_force_N = kMicro * capabilities_.max_force_uN;
  c.max_torque_Nm = kMicro * capabilities_.max_torque_uNm;
  c.rate_Hz = capabilities_.rate_Hz;
  c.sensed_dof = capabilities_.sensed_dof;
  c.rendered_dof = capabilities_.rendered_dof;
  return c;
}

std::optional<DeviceProblem> HostDriver::begin(Transport& transport) {
  end_ = HostEnd(capabilities_, chain_);
  last_no_force_ns_ = 0;
  enabled_ = false;
  const ControlRequest request{kVendorOut, static_cast<std::uint8_t>(Request::session), 1,
                               transport.interface_number()};
  const IoResult result = transport.control_out(request, {}, kControlTimeout_ms);
  if (result.ok()) return std::nullopt;
  return DeviceProblem{"session", describe(result.status), "plug the device in again"};
}

bool HostDriver::received(std::span<const std::byte> bytes, std::uint64_t now_ns,
                          DeviceState& out) noexcept {
  return end_.receive(bytes, now_ns, out);
}

std::size_t HostDriver::poll(const DeviceCommand& command, bool fresh, std::uint64_t now_ns,
                             OutBuffer& out) noexcept {
  const bool expired = now_ns >= command.expires_ns;
  if (fresh && !expired) {
    enabled_ = true;
    return copy(end_.command(command, now_ns), out);
  }
  const bool has_ended = enabled_ && expired;
  const bool due = !enabled_ && now_ns - last_no_force_ns_ >= kNoForceEvery_ns;
  if (!has_ended && !due) return 0;
  enabled_ = false;
  last_no_force_ns_ = now_ns;
  return copy(end_.no_force(), out);
}

std::size_t HostDriver::farewell(OutBuffer& out) noexcept { return copy(end_.no_force(), out); }

void HostDriver::end(Transport& transport) noexcept {
  const ControlRequest request{kVendorOut, static_cast<std::uint8_t>(Request::session), 0,
                               transport.interface_number()};
  static_cast<void>(transport.control_out(request, {}, kControlTimeout_ms));
}

std::uint32_t HostDriver::faults(std::uint64_t /*now_ns*/) const noexcept {
  return kNoDeviceFault;  // a silent device shows as stale readings
}

double HostDriver::first_reading_within_s() const noexcept { return kFirstReadingWithin_s; }

DeviceProblem HostDriver::why_no_reading() const {
  if (end_.counters().refused > 0) {
    return {"first reading", "every packet of the device is refused",
            "update the device's firmware to docs/PROTOCOL.md"};
  }
  return {"first reading", "the device sends nothing", "plug the device in again"};
}

}  // namespace palpate::hal::protocol

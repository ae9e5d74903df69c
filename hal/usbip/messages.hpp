// SPDX-License-Identifier: Apache-2.0
// The messages of USB/IP 1.1.1, with which a USB device is used over a TCP connection: a client
// asks for the list of devices or takes one, and from then on sends its transfers.
//
// Source: the Linux kernel's Documentation/usb/usbip_protocol.rst. Big-endian. Left out:
// isochronous transfers, which haptic devices have no use for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "hal/simulator/descriptors.hpp"
#include "hal/transport/transport.hpp"

namespace palpate::hal::usbip {

inline constexpr std::uint16_t kTcpPort = 3240;
inline constexpr std::uint16_t kVersion = 0x0111;
inline constexpr std::size_t kOperationBytes = 8;
inline constexpr std::size_t kBusIdBytes = 32;
inline constexpr std::size_t kDeviceBytes = 312;  ///< without its interfaces
inline constexpr std::size_t kInterfaceBytes = 4;
inline constexpr std::size_t kTransferHeaderBytes = 48;
/// Where the one device is.
inline constexpr std::string_view kBusId = "1-1";
inline constexpr std::uint32_t kBusNumber = 1;
inline constexpr std::uint32_t kDeviceNumber = 2;

enum class Code : std::uint16_t {
  list_request = 0x8005,
  list_reply = 0x0005,
  import_request = 0x8003,
  import_reply = 0x0003
};

/// What a connection begins with. The list request is nothing more; an import request is followed
/// by kBusIdBytes of the device's bus id, filled up with zeros.
struct Operation {
  std::uint16_t version = kVersion;
  Code code = Code::list_request;
  std::uint32_t status = 0;  ///< of a reply: 0 done, 1 not
};

enum class Command : std::uint32_t { submit = 1, unlink = 2, submit_reply = 3, unlink_reply = 4 };

/// Ends of a transfer, as Linux numbers them.
enum TransferStatus : std::int32_t {
  kDone = 0,
  kStalled = -32,   ///< EPIPE
  kOverflow = -75,  ///< EOVERFLOW
  kUnlinked = -104  ///< ECONNRESET
};

/// What stands before the data of a transfer or of its end; what does not belong to a command is 0.
/// Data follow a submit to an OUT endpoint (`length`) and the reply to one from an IN endpoint
/// (`length`).
struct TransferHeader {
  Command command = Command::submit;
  std::uint32_t sequence = 0;
  std::uint32_t device = 0;          ///< of requests: bus number << 16 | device number
  bool is_in = false;                ///< of requests
  std::uint32_t endpoint = 0;        ///< of requests: its number, 0 to 15
  std::uint32_t length = 0;          ///< submit: bytes wanted or sent; its reply: bytes moved
  std::int32_t status = kDone;       ///< of replies
  std::uint32_t victim = 0;          ///< unlink: the sequence of the transfer to be given up
  std::array<std::byte, 8> setup{};  ///< submit to endpoint 0
};

[[nodiscard]] std::array<std::byte, kOperationBytes> encode(const Operation& operation) noexcept;
[[nodiscard]] Operation decode_operation(
    std::span<const std::byte, kOperationBytes> bytes) noexcept;

[[nodiscard]] std::array<std::byte, kTransferHeaderBytes> encode(
    const TransferHeader& header) noexcept;
/// False, and `out` untouched, where the command, direction or endpoint is none, or the length
/// negative.
[[nodiscard]] bool decode(std::span<const std::byte, kTransferHeaderBytes> bytes,
                          TransferHeader& out) noexcept;

/// The record of the device in replies: kDeviceBytes, and kInterfaceBytes for each interface where
/// they are asked for.
[[nodiscard]] std::vector<std::byte> describe(const simulator::UsbDescriptors& descriptors,
                                              bool with_interfaces);

/// Whether the configuration has an endpoint. @param address  with its direction in bit 7
[[nodiscard]] bool has_endpoint(const simulator::UsbDescriptors& descriptors,
                                std::uint8_t address) noexcept;

/// A set-up packet (USB 2.0, 9.3), and the length that it asks for.
struct Setup {
  ControlRequest request;
  std::uint16_t length = 0;
};
[[nodiscard]] Setup decode_setup(const std::array<std::byte, 8>& bytes) noexcept;
[[nodiscard]] std::array<std::byte, 8> encode_setup(const Setup& setup) noexcept;

}  // namespace palpate::hal::usbip

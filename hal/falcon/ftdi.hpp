// SPDX-License-Identifier: Apache-2.0
// The FTDI serial bridge in front of the Falcon's processor: line settings by vendor requests, and
// a stream of bytes in packets that begin with two status bytes.
//
// Source: the vendor requests as the libnifalcon project uses them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/transport/transport.hpp"

namespace palpate::hal::falcon {

inline constexpr std::uint16_t kVendorId = 0x0403;
inline constexpr std::uint16_t kProductId = 0xcb48;
inline constexpr std::size_t kUsbPacketBytes = 64;
inline constexpr std::size_t kStatusBytes = 2;
inline constexpr std::size_t kMaxPayload = kUsbPacketBytes - kStatusBytes;
/// Room for one IN transfer: replies larger than expected have been seen.
inline constexpr std::size_t kTransferBytes = 512;

/// wValue of the baud rate request: 3 MHz by a divisor, whose fraction is coded in the upper bits.
enum class Baud : std::uint16_t { b9600 = 0x4138, b140k = 0x0015, b1500k = 0x0002 };

/// bRequest.
enum class FtdiRequest : std::uint8_t {
  purge = 0,  ///< wValue 1 receiver, 2 transmitter
  modem = 1,  ///< wValue 0x0100 DTR low, 0x0101 high, 0x0200 RTS low, 0x0202 high
  flow_control = 2,
  baud = 3,
  line = 4,  ///< wValue 8: 8 bits, no parity, 1 stop bit
  set_latency = 9,
  get_latency = 10
};
inline constexpr std::uint8_t kFtdiOut = 0x40;  ///< bmRequestType: vendor, device
inline constexpr std::uint8_t kFtdiIn = 0xc0;

/// Removes the status bytes of every packet of one transfer, in place; how many bytes are left at
/// the front.
[[nodiscard]] std::size_t strip_status(std::span<std::byte> transfer) noexcept;

/// Set-up calls block for at most half a second each; status lost or stalled where the bridge does
/// not answer as it has to.
class FtdiLine {
 public:
  explicit FtdiLine(Transport& transport) : transport_(transport) {}

  IoStatus purge();
  IoStatus set_baud(Baud baud);
  IoStatus set_8n1_without_flow_control();
  IoStatus set_dtr(bool high);
  IoStatus set_rts(bool high);
  /// How long the bridge collects bytes before it sends them; reads it back, for some bridges
  /// ignore the request, and 16 ms in place of 1 ms is 62 Hz in place of 1000. failed: it did not
  /// take it.
  IoStatus set_latency_ms(std::uint8_t latency_ms);

  IoStatus write(std::span<const std::byte> bytes);

  /// Reads until `out` is full. timed_out where the bytes do not come within a number of transfers;
  /// `bytes` says how many came. What comes beyond is dropped.
  IoResult read(std::span<std::byte> out);

 private:
  IoStatus request(FtdiRequest what, std::uint16_t value);
  Transport& transport_;
};

}  // namespace palpate::hal::falcon

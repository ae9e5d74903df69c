// SPDX-License-Identifier: Apache-2.0
// One open USB interface, as drivers see it: libusb behind it on a host, a simulated device in
// tests.
//
// A transport belongs to one thread at a time: the control thread until streaming begins, then the
// device's I/O thread. Nothing here is for the real-time thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::hal {

enum class IoStatus : std::uint8_t {
  ok,
  timed_out,
  stalled,  ///< the device does not know the request, or refuses it now
  lost,     ///< unplugged, or the bus failed; nothing will work any more
  failed    ///< the transfer failed; the next one may work
};

/// Static storage, never null.
[[nodiscard]] const char* describe(IoStatus status) noexcept;

struct IoResult {
  IoStatus status = IoStatus::ok;
  std::size_t bytes = 0;  ///< moved
  [[nodiscard]] bool ok() const noexcept { return status == IoStatus::ok; }
};

/// The first fields of a USB set-up packet.
struct ControlRequest {
  std::uint8_t type = 0;  ///< bmRequestType
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
};

/// Where streaming delivers. Called from Transport::wait() only.
class StreamSink {
 public:
  virtual ~StreamSink() = default;
  StreamSink() = default;
  StreamSink(const StreamSink&) = delete;
  StreamSink& operator=(const StreamSink&) = delete;
  StreamSink(StreamSink&&) = delete;
  StreamSink& operator=(StreamSink&&) = delete;

  /// The bytes of one IN transfer, valid during the call.
  virtual void received(std::span<const std::byte> bytes, std::uint64_t now_ns) noexcept = 0;
};

class Transport {
 public:
  virtual ~Transport() = default;
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  Transport(Transport&&) = delete;
  Transport& operator=(Transport&&) = delete;

  /// Of the interface that is claimed: wIndex of requests to it.
  [[nodiscard]] virtual std::uint8_t interface_number() const noexcept = 0;

  // Set-up: each call blocks for at most its timeout.

  /// A control transfer that reads; `result.bytes` of `out` are valid.
  virtual IoResult control_in(const ControlRequest& request, std::span<std::byte> out,
                              std::uint32_t timeout_ms) = 0;
  /// A control transfer that writes, or has no data.
  virtual IoResult control_out(const ControlRequest& request, std::span<const std::byte> data,
                               std::uint32_t timeout_ms) = 0;
  /// Chooses an alternate setting of the interface.
  virtual IoStatus select_alternate(std::uint8_t setting) = 0;
  /// One transfer from the IN endpoint. `out` has room for whole packets.
  virtual IoResult read(std::span<std::byte> out, std::uint32_t timeout_ms) = 0;
  /// One transfer to the OUT endpoint.
  virtual IoResult write(std::span<const std::byte> data, std::uint32_t timeout_ms) = 0;

  // Streaming: IN transfers are kept pending, OUT transfers come from a fixed pool, none has a
  // timeout.

  /// Submits the IN transfers.
  virtual IoStatus begin_stream() = 0;

  /// Queues one OUT transfer. False where the whole pool is under way, or the device is lost: the
  /// caller drops it and sends a newer one later. @param data  at most 64 bytes
  virtual bool submit(std::span<const std::byte> data) = 0;

  /// OUT transfers under way.
  [[nodiscard]] virtual std::size_t pending() const noexcept = 0;

  /// Delivers what arrives, until something has arrived or a time has come.
  /// @return lost, or ok whether or not anything came
  virtual IoStatus wait(std::uint64_t until_ns, StreamSink& sink) = 0;

  /// Cancels what is under way and waits for it, at most a second. Harmless when not streaming.
  virtual void end_stream() noexcept = 0;
};

}  // namespace palpate::hal

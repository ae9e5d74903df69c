// SPDX-License-Identifier: Apache-2.0
// The other end: a device that a server of USB/IP has, as a transport. It needs no kernel module
// and no rights. What the server says is not trusted: what breaks the protocol, asks for more room
// than was given, or stops in the middle of a message for two seconds, loses the device.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "hal/clock.hpp"
#include "hal/device.hpp"
#include "hal/transport/transport.hpp"
#include "hal/usbip/messages.hpp"

namespace palpate::hal::usbip {

/// Of the device's interface for the exchange: its number, and its endpoints' numbers.
struct ClientInterface {
  std::uint8_t number = 0;
  std::uint32_t in_endpoint = 1, out_endpoint = 1;
};

class ClientTransport final : public Transport {
 public:
  static constexpr std::size_t kInTransfers = 4;
  static constexpr std::size_t kOutTransfers = 4;
  static constexpr std::size_t kInBytes = 64;

  /// @param fd  connected; taken over
  explicit ClientTransport(int fd, const ClientInterface& interface = {});
  ~ClientTransport() override;
  ClientTransport(const ClientTransport&) = delete;
  ClientTransport& operator=(const ClientTransport&) = delete;
  ClientTransport(ClientTransport&&) = delete;
  ClientTransport& operator=(ClientTransport&&) = delete;

  /// Takes the device, before anything else. False where the server refuses or is gone.
  [[nodiscard]] bool import(std::string_view bus_id = kBusId);
  /// Chooses another interface of it.
  void use(const ClientInterface& interface) { interface_ = interface; }

  [[nodiscard]] std::uint8_t interface_number() const noexcept override {
    return interface_.number;
  }
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out,
                      std::uint32_t timeout_ms) override;
  IoResult control_out(const ControlRequest& request, std::span<const std::byte> data,
                       std::uint32_t timeout_ms) override;
  IoStatus select_alternate(std::uint8_t setting) override;
  IoResult read(std::span<std::byte> out, std::uint32_t timeout_ms) override;
  IoResult write(std::span<const std::byte> data, std::uint32_t timeout_ms) override;
  IoStatus begin_stream() override;
  bool submit(std::span<const std::byte> data) override;
  [[nodiscard]] std::size_t pending() const noexcept override;
  IoStatus wait(std::uint64_t until_ns, StreamSink& sink) override;
  void end_stream() noexcept override;

 private:
  enum class Use : std::uint8_t { none, alone, stream_in, stream_out, unlink };
  /// A request that the server has not answered.
  struct Request {
    std::uint32_t sequence = 0;
    Use use = Use::none;
    bool is_in = false;
    bool unwanted = false;     ///< whoever waited for it waits no longer
    std::uint32_t room = 0;    ///< of its data
    std::uint32_t victim = 0;  ///< of an unlink
  };
  static constexpr std::size_t kRequests = 32;
  static constexpr std::size_t kMostBytes = 4096;  ///< of one transfer

  /// How a request ended; its data are in data_.
  struct End {
    Request request;
    std::int32_t status = kDone;
    std::size_t bytes = 0;
  };

  /// 0 where there is no room for it, or the server is gone.
  std::uint32_t send(Use use, TransferHeader header, std::span<const std::byte> data);
  std::optional<End> next_end(std::uint64_t until_ns);
  IoResult finish(std::uint32_t sequence, std::span<std::byte> out, std::uint32_t timeout_ms);
  Request* find(std::uint32_t sequence) noexcept;
  void stream_in();
  void unlink(const Request& request);
  bool send_all(std::span<const std::byte> bytes) const;
  bool receive_all(std::span<std::byte> bytes) const;

  int fd_;
  ClientInterface interface_;
  MonotonicClock clock_;
  std::uint32_t device_ = kBusNumber << 16 | kDeviceNumber;
  std::uint32_t sequence_ = 0;
  std::array<Request, kRequests> requests_{};
  std::array<std::byte, kMostBytes> data_{};
  std::array<std::byte, kTransferHeaderBytes + kMostBytes> message_{};
  bool lost_ = false;
};

/// The first device of the open protocol that a server exports, taken and set up. May block for
/// some seconds. @param host  a name or an address
[[nodiscard]] std::variant<std::unique_ptr<Transport>, DeviceProblem> open_device(
    const std::string& host, std::uint16_t port = kTcpPort);

}  // namespace palpate::hal::usbip

// SPDX-License-Identifier: Apache-2.0
// A client of USB/IP, and the device that it takes as a transport.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "hal/clock.hpp"
#include "hal/transport/transport.hpp"
#include "hal/usbip/messages.hpp"

namespace palpate::hal::test {

/// A socket to a server on this machine; -1 where there is none.
inline int connect_to(std::uint16_t port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(port);
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd, reinterpret_cast<sockaddr*>(&name), sizeof name) == 0) return fd;
  ::close(fd);
  return -1;
}

/// The request for the device, as bytes.
inline std::vector<std::byte> import_request() {
  const auto head = usbip::encode(usbip::Operation{usbip::kVersion, usbip::Code::import_request});
  std::vector<std::byte> bytes(head.begin(), head.end());
  for (const char c : usbip::kBusId) bytes.push_back(static_cast<std::byte>(c));
  bytes.resize(usbip::kOperationBytes + usbip::kBusIdBytes);
  return bytes;
}

class UsbipTransport final : public Transport {
 public:
  static constexpr std::size_t kInTransfers = 4;
  static constexpr std::size_t kOutTransfers = 4;

  /// @param fd  connected; taken over  @param interface  that requests are for
  explicit UsbipTransport(int fd, std::uint8_t interface = 0) : fd_(fd), interface_(interface) {}
  ~UsbipTransport() override { ::close(fd_); }

  /// Takes the device. False where the server refuses or is gone.
  bool import() {
    std::array<std::byte, usbip::kOperationBytes> head{};
    if (!send_all(import_request()) || !receive_all(head)) return false;
    if (usbip::decode_operation(head).status != 0) return false;
    std::array<std::byte, usbip::kDeviceBytes> device{};
    return receive_all(device);
  }

  [[nodiscard]] std::uint8_t interface_number() const noexcept override { return interface_; }
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out,
                      std::uint32_t timeout_ms) override {
    usbip::TransferHeader h = control(request, out.size());
    h.is_in = true;
    return finish(submit_now(h, {}), out, timeout_ms);
  }
  IoResult control_out(const ControlRequest& request, std::span<const std::byte> data,
                       std::uint32_t timeout_ms) override {
    return finish(submit_now(control(request, data.size()), data), {}, timeout_ms);
  }
  IoStatus select_alternate(std::uint8_t setting) override {
    return control_out({0x01, 0x0b, setting, interface_}, {}, 1000).status;
  }
  IoResult read(std::span<std::byte> out, std::uint32_t timeout_ms) override {
    return finish(submit_now(in_header(out.size()), {}), out, timeout_ms);
  }
  IoResult write(std::span<const std::byte> data, std::uint32_t timeout_ms) override {
    return finish(submit_now(out_header(data.size()), data), {}, timeout_ms);
  }

  IoStatus begin_stream() override {
    for (std::size_t i = 0; i < kInTransfers; ++i) stream_in();
    return lost_ ? IoStatus::lost : IoStatus::ok;
  }
  bool submit(std::span<const std::byte> data) override {
    if (lost_ || pending_out_ == kOutTransfers) return false;
    submit_now(out_header(data.size()), data);
    ++pending_out_;
    return !lost_;
  }
  [[nodiscard]] std::size_t pending() const noexcept override { return pending_out_; }
  IoStatus wait(std::uint64_t until_ns, StreamSink& sink) override {
    while (!lost_) {
      const auto end = next_end(until_ns);
      if (!end) break;
      const bool is_reading = in_flight_.erase(end->header.sequence) > 0;
      if (!is_reading) {
        pending_out_ -= std::min<std::size_t>(pending_out_, 1);
        continue;
      }
      if (end->header.status == usbip::kDone) sink.received(end->data, clock_.now_ns());
      stream_in();
      return lost_ ? IoStatus::lost : IoStatus::ok;
    }
    return lost_ ? IoStatus::lost : IoStatus::ok;
  }
  void end_stream() noexcept override {
    for (const std::uint32_t sequence : in_flight_) {
      usbip::TransferHeader h;
      h.command = usbip::Command::unlink;
      h.victim = sequence;
      submit_now(h, {});
    }
    in_flight_.clear();
    pending_out_ = 0;
  }

  /// How a transfer ended.
  struct End {
    usbip::TransferHeader header;
    std::vector<std::byte> data;
  };
  /// Sends one request; its sequence.
  std::uint32_t submit_now(usbip::TransferHeader header, std::span<const std::byte> data) {
    header.sequence = ++sequence_;
    header.device = usbip::kBusNumber << 16 | usbip::kDeviceNumber;
    const bool wants_data = header.command == usbip::Command::submit && header.is_in;
    if (wants_data) awaits_data_.insert(header.sequence);
    const auto bytes = usbip::encode(header);
    std::vector<std::byte> message(bytes.begin(), bytes.end());
    message.insert(message.end(), data.begin(), data.end());
    if (!send_all(message)) lost_ = true;
    return header.sequence;
  }
  /// The next answer of the server; absent where none comes in time or the device is lost.
  std::optional<End> next_end(std::uint64_t until_ns) {
    while (!lost_) {
      const std::uint64_t now_ns = clock_.now_ns();
      const std::uint64_t left_ns = until_ns > now_ns ? until_ns - now_ns : 0;
      pollfd file{fd_, POLLIN, 0};
      const timespec patience{static_cast<time_t>(left_ns / 1'000'000'000),
                              static_cast<long>(left_ns % 1'000'000'000)};
      if (::ppoll(&file, 1, &patience, nullptr) == 0) return std::nullopt;
      End end;
      std::array<std::byte, usbip::kTransferHeaderBytes> head{};
      lost_ = !receive_all(head) || !usbip::decode(head, end.header);
      if (lost_) break;
      if (awaits_data_.erase(end.header.sequence) > 0) {
        end.data.resize(end.header.length);
        lost_ = !receive_all(end.data);
      }
      if (!lost_) return end;
    }
    return std::nullopt;
  }
  static usbip::TransferHeader in_header(std::size_t length) {
    usbip::TransferHeader h;
    h.is_in = true;
    h.endpoint = 1;
    h.length = static_cast<std::uint32_t>(length);
    return h;
  }

 private:
  static usbip::TransferHeader out_header(std::size_t length) {
    usbip::TransferHeader h = in_header(length);
    h.is_in = false;
    return h;
  }
  static usbip::TransferHeader control(const ControlRequest& r, std::size_t length) {
    usbip::TransferHeader h;
    h.length = static_cast<std::uint32_t>(length);
    const auto low = [](std::size_t v) { return static_cast<std::byte>(v & 0xff); };
    h.setup = {low(r.type),  low(r.request),     low(r.value), low(r.value >> 8u),
               low(r.index), low(r.index >> 8u), low(length),  low(length >> 8u)};
    return h;
  }
  void stream_in() { in_flight_.insert(submit_now(in_header(64), {})); }

  IoResult finish(std::uint32_t sequence, std::span<std::byte> out, std::uint32_t timeout_ms) {
    const std::uint64_t until_ns = clock_.now_ns() + std::uint64_t{timeout_ms} * 1'000'000;
    while (const auto end = next_end(until_ns)) {
      if (end->header.sequence != sequence) continue;  // of what was given up before
      if (end->header.status == usbip::kStalled) return {IoStatus::stalled};
      if (end->header.status != usbip::kDone) return {IoStatus::failed};
      std::copy_n(end->data.begin(), std::min(out.size(), end->data.size()), out.begin());
      return {IoStatus::ok, end->header.length};
    }
    return {lost_ ? IoStatus::lost : IoStatus::timed_out};
  }
  bool send_all(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
    return true;
  }
  bool receive_all(std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t got = ::recv(fd_, bytes.data(), bytes.size(), 0);
      if (got <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(got));
    }
    return true;
  }

  int fd_;
  std::uint8_t interface_;
  MonotonicClock clock_;
  std::uint32_t sequence_ = 0;
  std::set<std::uint32_t> awaits_data_;
  std::set<std::uint32_t> in_flight_;  ///< of the stream
  std::size_t pending_out_ = 0;
  bool lost_ = false;
};

}  // namespace palpate::hal::test

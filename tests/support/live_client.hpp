// SPDX-License-Identifier: GPL-3.0-or-later
// A page's side of a live view, on plain sockets: HTTP requests and WebSocket frames, sound and
// unsound.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate::test {

/// "http://127.0.0.1:PORT/TOKEN/" in parts.
struct LiveAddress {
  explicit LiveAddress(const std::string& url) {
    const std::size_t port_at = url.rfind(':') + 1;
    const std::size_t slash = url.find('/', port_at);
    port = static_cast<std::uint16_t>(std::atoi(url.substr(port_at, slash - port_at).c_str()));
    path = url.substr(slash);
  }
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(port); }
  std::uint16_t port = 0;
  std::string path;  ///< "/TOKEN/"
};

class LiveClient {
 public:
  static constexpr int kWait_ms = 5000;

  explicit LiveClient(std::uint16_t port, int receive_buffer_bytes = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (receive_buffer_bytes > 0) {
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes,
                   sizeof receive_buffer_bytes);
    }
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the interface of sockets
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) drop();
  }
  ~LiveClient() { drop(); }
  LiveClient(LiveClient&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), bytes_(std::move(other.bytes_)) {}
  LiveClient& operator=(LiveClient&&) = delete;
  LiveClient(const LiveClient&) = delete;
  LiveClient& operator=(const LiveClient&) = delete;

  void send(const std::string& text) const {
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t n = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return;
      sent += static_cast<std::size_t>(n);
    }
  }

  /// All that comes until the other side closes or nothing comes for a while.
  std::string read_all(int wait_ms = kWait_ms) {
    while (more(wait_ms)) {
    }
    return std::exchange(bytes_, {});
  }

  /// Whether the other side closes within the time; what it says is thrown away.
  bool closes(int wait_ms = kWait_ms) {
    for (;;) {
      pollfd readable{socket_, POLLIN, 0};
      if (::poll(&readable, 1, wait_ms) <= 0) return false;
      char buffer[4096];
      if (::recv(socket_, buffer, sizeof buffer, 0) <= 0) return true;
    }
  }

  /// Asks for the WebSocket; the status of the answer, 101 where it is had.
  int upgrade(const LiveAddress& address, const std::string& origin, const std::string& more = {}) {
    send("GET " + address.path + "live HTTP/1.1\r\nHost: " + address.host() +
         "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
         (origin.empty() ? "" : "Origin: " + origin + "\r\n") + more + "\r\n");
    std::size_t end = std::string::npos;
    while ((end = bytes_.find("\r\n\r\n")) == std::string::npos && more_bytes()) {
    }
    if (end == std::string::npos || bytes_.size() < 12) return 0;
    const int status = std::atoi(bytes_.substr(9, 3).c_str());
    bytes_.erase(0, end + 4);
    return status;
  }
  int upgrade(const LiveAddress& address) { return upgrade(address, "http://" + address.host()); }

  /// The next binary message; absent where none comes or the other side closes.
  std::optional<std::vector<std::byte>> message() {
    for (;;) {
      const auto frame = next_frame();
      if (!frame || frame->first == 8) return std::nullopt;
      if (frame->first == 2) return frame->second;
    }
  }

  /// A whole masked frame with a mask of zeros. @param kind  1 text, 2 binary
  static std::string masked(int kind, std::span<const std::byte> payload) {
    std::string out(1, static_cast<char>(0x80 | kind));
    const std::size_t size = payload.size();
    if (size < 126) {
      out += static_cast<char>(0x80 | size);
    } else {
      out += static_cast<char>(0x80 | 126);
      out += static_cast<char>(size >> 8);
      out += static_cast<char>(size & 255);
    }
    out.append(4, '\0');
    for (const std::byte b : payload) out += static_cast<char>(b);
    return out;
  }

 private:
  using Frame = std::pair<int, std::vector<std::byte>>;

  bool more(int wait_ms) {
    pollfd readable{socket_, POLLIN, 0};
    if (::poll(&readable, 1, wait_ms) <= 0) return false;
    char buffer[65536];
    const ssize_t n = ::recv(socket_, buffer, sizeof buffer, 0);
    if (n <= 0) return false;
    bytes_.append(buffer, static_cast<std::size_t>(n));
    return true;
  }
  bool more_bytes() { return more(kWait_ms); }

  /// {kind, payload} of a frame as servers send them, without a mask.
  std::optional<Frame> next_frame() {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes_[i]); };
    for (;;) {
      if (bytes_.size() >= 2) {
        std::size_t head = 2, size = byte(1);
        const std::size_t words = size == 126 ? 2 : size == 127 ? 8 : 0;
        head += words;
        if (bytes_.size() >= head) {
          if (words > 0) size = 0;
          for (std::size_t i = 0; i < words; ++i) size = size << 8 | byte(2 + i);
          if (bytes_.size() >= head + size) {
            Frame frame{byte(0) & 15, {}};
            for (std::size_t i = head; i < head + size; ++i) {
              frame.second.push_back(std::byte{byte(i)});
            }
            bytes_.erase(0, head + size);
            return frame;
          }
        }
      }
      if (!more_bytes()) return std::nullopt;
    }
  }

  void drop() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }

  int socket_;
  std::string bytes_;  ///< received and not yet read
};

}  // namespace palpate::test

// SPDX-License-Identifier: GPL-3.0-or-later
// A page and a WebSocket on 127.0.0.1, on one ordinary thread, for whoever knows the address.
//
//   GET /TOKEN/      the page
//   GET /TOKEN/live  a WebSocket: frames come as fast as they are taken, at most one every
//                    ServerLimits::frame; what the page says goes to Source::message()
//
// Host and Origin must be this server's; anything else is answered with an error and closed.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace palpate::live {

/// What pages are shown. Called by the server's thread alone.
class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  Source(Source&&) = delete;
  Source& operator=(Source&&) = delete;

  /// Once before each round of frames, with pages or without.
  virtual void update() = 0;

  /// The next frame of one page. @param seen  what it has been sent before, 0 at first; kept here
  virtual void frame(std::uint64_t& seen, std::vector<std::byte>& out) const = 0;

  /// What a page says. False: it is disconnected.
  [[nodiscard]] virtual bool message(std::span<const std::byte> bytes) = 0;

  /// A page that had said something is gone.
  virtual void left() = 0;
};

struct ServerLimits {
  std::size_t pages = 4;         ///< another one is told that there are too many
  std::size_t connections = 16;  ///< another one is closed at once
  std::size_t message_bytes = 256;
  std::size_t messages_a_frame = 200;       ///< a page that says more is disconnected
  std::size_t header_bytes = 8192;          ///< of a request
  std::chrono::milliseconds request{5000};  ///< for a whole request, and for an answer
  std::chrono::milliseconds stalled{2000};  ///< a page that takes no frame for so long is dropped
  std::chrono::milliseconds silent{20000};  ///< nor even a pong to a ping: likewise
  std::chrono::milliseconds frame{16};      ///< a display's
  std::chrono::milliseconds farewell{300};  ///< for the last frame, at the end
  int send_buffer_bytes = 128 * 1024;       ///< what a page may lie behind, nearly
};

class Server {
 public:
  /// Listens, and serves from now on. @param page  HTML  @param port  0: any free one
  /// Throws std::system_error where the port cannot be had. `source` outlives this.
  Server(std::string page, std::uint16_t port, Source& source, const ServerLimits& limits = {});

  /// Sends a last frame to each page and ends; no longer than `farewell`.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  Server(Server&&) = delete;
  Server& operator=(Server&&) = delete;

  /// "http://127.0.0.1:PORT/TOKEN/"
  [[nodiscard]] std::string address() const;

  /// Pages that are shown frames. Any thread.
  [[nodiscard]] std::size_t pages() const noexcept;

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace palpate::live

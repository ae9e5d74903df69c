// SPDX-License-Identifier: Apache-2.0
// A simulated device on TCP, by USB/IP: whoever has Linux's vhci_hcd attaches it and has a USB
// device like any other.
//
// There is neither encryption nor a password in the protocol: listen on 127.0.0.1, and reach it
// from elsewhere through a tunnel.
#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <string>

#include "hal/clock.hpp"
#include "hal/usbip/session.hpp"

namespace palpate::hal::usbip {

/// A file descriptor that closes itself.
class Socket {
 public:
  explicit Socket(int fd) noexcept : fd_(fd) {}
  ~Socket();
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  Socket(Socket&&) = delete;
  Socket& operator=(Socket&&) = delete;
  [[nodiscard]] int fd() const noexcept { return fd_; }

 private:
  int fd_;
};

/// All calls on one thread.
class Server {
 public:
  static constexpr std::size_t kMaxClients = 8;  ///< more are turned away
  static constexpr std::size_t kMaxUnsentBytes =
      1u << 20;  ///< a client that reads too little is closed

  /// Listens. Device and clock must outlive this. @param address  IPv4, in dots  @param port  0:
  /// any that is free. Throws std::system_error where it cannot.
  Server(simulator::SimulatedDevice& device, Clock& clock, const std::string& address,
         std::uint16_t port);

  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

  /// The device lives and clients are served, until a time at most; returns when something was
  /// done.
  void step(std::uint64_t until_ns);

  /// Takes over a socket that is connected already.
  void adopt(int fd);

  /// The same, of a client that has the device from now on and does not ask for it.
  void adopt_owner(int fd);

  /// A client has taken the device.
  [[nodiscard]] bool attached() const noexcept { return exported_.taken; }

 private:
  struct Client {
    Client(int fd, ExportedDevice& exported) : socket(fd), session(exported) {}
    Socket socket;
    Session session;
  };
  void accept_all();
  /// False: to be closed.
  [[nodiscard]] bool read_from(Client& client);
  [[nodiscard]] static bool write_to(Client& client);
  void live();
  /// A device that leaves its bus is gone for who has it.
  void close_after_departure();

  Clock& clock_;
  ExportedDevice exported_;
  Socket listener_;
  std::uint16_t port_ = 0;
  std::uint32_t times_left_ = 0;  ///< what the device says
  std::list<Client> clients_;
};

}  // namespace palpate::hal::usbip

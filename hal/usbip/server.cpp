// SPDX-License-Identifier: Apache-2.0
#include "hal/usbip/server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <system_error>
#include <vector>

namespace palpate::hal::usbip {
namespace {

constexpr std::uint64_t kNsPerSecond = 1'000'000'000;

[[noreturn]] void fail(int error, const std::string& where) {
  throw std::system_error(error, std::generic_category(), where);
}

int checked(int result, const std::string& where) {
  if (result < 0) fail(errno, where);
  return result;
}

bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}  // namespace

Socket::~Socket() {
  if (fd_ >= 0) ::close(fd_);
}

Server::Server(simulator::SimulatedDevice& device, Clock& clock, const std::string& address,
               std::uint16_t port)
    : clock_(clock),
      exported_{device},
      listener_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  const std::string where = address + ":" + std::to_string(port);
  checked(listener_.fd(), where);
  const int yes = 1;
  ::setsockopt(listener_.fd(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(port);
  if (::inet_pton(AF_INET, address.c_str(), &name.sin_addr) != 1) fail(EINVAL, where);
  auto* generic = reinterpret_cast<sockaddr*>(&name);
  checked(::bind(listener_.fd(), generic, sizeof name), where);
  checked(::listen(listener_.fd(), static_cast<int>(kMaxClients)), where);
  socklen_t length = sizeof name;
  checked(::getsockname(listener_.fd(), generic, &length), where);
  port_ = ntohs(name.sin_port);
}

void Server::adopt(int fd) { clients_.emplace_back(fd, exported_); }

void Server::adopt_owner(int fd) {
  adopt(fd);
  clients_.back().session.take();
}

void Server::accept_all() {
  while (true) {
    const int fd = ::accept4(listener_.fd(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0) return;
    if (clients_.size() == kMaxClients) {
      ::close(fd);
      continue;
    }
    const int yes = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    adopt(fd);
  }
}

bool Server::read_from(Client& client) {
  std::array<std::byte, 16 * 1024> bytes;
  while (true) {
    const ssize_t got = ::recv(client.socket.fd(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got == 0 || (got < 0 && !would_block())) return false;
    if (got < 0) return true;
    if (!client.session.receive(std::span(bytes).first(static_cast<std::size_t>(got)))) {
      return false;
    }
  }
}

bool Server::write_to(Client& client) {
  std::vector<std::byte>& bytes = client.session.output();
  while (!bytes.empty()) {
    const ssize_t sent =
        ::send(client.socket.fd(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0) return would_block() && bytes.size() <= kMaxUnsentBytes;
    bytes.erase(bytes.begin(), bytes.begin() + sent);
  }
  return true;
}

void Server::live() {
  exported_.device.advance_to(clock_.now_ns());
  for (Client& client : clients_) client.session.serve();
}

void Server::close_after_departure() {
  const std::uint32_t times = exported_.device.presence().times_left;
  if (times == times_left_) return;
  times_left_ = times;
  clients_.remove_if([](const Client& client) { return client.session.attached(); });
}

void Server::step(std::uint64_t until_ns) {
  live();
  close_after_departure();
  for (auto client = clients_.begin(); client != clients_.end();) {
    client = write_to(*client) ? std::next(client) : clients_.erase(client);
  }
  std::vector<pollfd> files{{listener_.fd(), POLLIN, 0}};
  for (const Client& client : clients_) files.push_back({client.socket.fd(), POLLIN, 0});
  const std::uint64_t now_ns = clock_.now_ns();
  const std::uint64_t wake_ns = std::min(until_ns, exported_.device.next_event_ns());
  const std::uint64_t for_ns = wake_ns > now_ns ? wake_ns - now_ns : 0;
  const timespec patience{static_cast<time_t>(for_ns / kNsPerSecond),
                          static_cast<long>(for_ns % kNsPerSecond)};
  if (::ppoll(files.data(), files.size(), &patience, nullptr) <= 0) return;
  live();
  auto client = clients_.begin();
  for (std::size_t i = 1; i < files.size(); ++i) {
    const bool keep = files[i].revents == 0 || (read_from(*client) && write_to(*client));
    client = keep ? std::next(client) : clients_.erase(client);
  }
  accept_all();
}

}  // namespace palpate::hal::usbip

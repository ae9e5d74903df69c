// SPDX-License-Identifier: Apache-2.0
// What a client of USB/IP begins with.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <vector>

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

}  // namespace palpate::hal::test

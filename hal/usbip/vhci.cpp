// SPDX-License-Identifier: Apache-2.0
#include "hal/usbip/vhci.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "hal/usbip/messages.hpp"

namespace palpate::hal::usbip {
namespace {

constexpr std::uint32_t kDevice = kBusNumber << 16 | kDeviceNumber;

/// A port of high or full speed.
struct Port {
  unsigned number = 0;
  bool is_free = false;
  std::uint32_t device = 0;  ///< bus number << 16 | device number, of the other side
};

/// "hub port sta spd dev sockfd local_busid", a line each.
std::vector<Port> ports_of(const std::filesystem::path& folder) {
  constexpr unsigned kFree = 4;
  std::vector<Port> ports;
  std::ifstream status(folder / "status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string hub;
    unsigned number = 0, state = 0, speed = 0;
    std::uint32_t device = 0;
    words >> hub >> number >> state >> speed >> std::hex >> device;
    if (words && hub == "hs") ports.push_back({number, state == kFree, device});
  }
  return ports;
}

}  // namespace

bool Vhci::has_device() const {
  for (const Port& port : ports_of(folder_)) {
    if (!port.is_free && port.device == kDevice) return true;
  }
  return false;
}

std::optional<unsigned> Vhci::free_port() const {
  for (const Port& port : ports_of(folder_)) {
    if (port.is_free) return port.number;
  }
  return std::nullopt;
}

bool Vhci::attach(int fd, simulator::UsbSpeed speed) const {
  const auto port = free_port();
  if (!port) return false;
  const std::string request = std::to_string(*port) + " " + std::to_string(fd) + " " +
                              std::to_string(kDevice) + " " +
                              std::to_string(static_cast<unsigned>(speed));
  // Whoever asks to read it is refused.
  const int file = ::open((folder_ / "attach").c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return false;
  const ssize_t written = ::write(file, request.data(), request.size());
  ::close(file);
  return written == static_cast<ssize_t>(request.size());
}

}  // namespace palpate::hal::usbip

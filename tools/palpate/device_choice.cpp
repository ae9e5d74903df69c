// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/device_choice.hpp"

#include <charconv>
#include <fstream>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "hal/falcon/bring_up.hpp"
#include "hal/falcon/driver.hpp"
#include "hal/transport/streamed_device.hpp"
#include "hal/usbip/client.hpp"
#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

std::vector<std::byte> read_firmware(const std::filesystem::path& file) {
  if (file.empty()) return {};
  std::ifstream in(file, std::ios::binary);
  // One byte more than is allowed says that there are more.
  std::vector<std::byte> bytes(hal::falcon::kMaxFirmwareBytes + 1);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (bytes.empty()) {
    throw Failure(kRefused, "cannot read the firmware file", file.string(),
                  "give the path of the maker's file");
  }
  return bytes;
}

/// HOST or HOST:PORT; absent where it is neither. An address of IPv6 has its colons in brackets.
std::optional<std::pair<std::string, std::uint16_t>> tcp_address(const std::string& text) {
  const bool bracketed = text.starts_with('[');
  const std::size_t host_end = bracketed ? text.find(']') : text.find(':');
  const std::string host = bracketed ? text.substr(1, host_end - 1) : text.substr(0, host_end);
  const std::string rest =
      host_end == std::string::npos ? "" : text.substr(host_end + (bracketed ? 1 : 0));
  if (host.empty() || (bracketed && host_end == std::string::npos)) return std::nullopt;
  if (rest.empty()) return std::pair(host, hal::usbip::kTcpPort);
  std::uint16_t port = 0;
  const char* const end = rest.data() + rest.size();
  const auto [stopped, error] = std::from_chars(rest.data() + 1, end, port);
  if (rest.front() != ':' || error != std::errc() || stopped != end || port == 0) {
    return std::nullopt;
  }
  return std::pair(host, port);
}

bool is_tcp(const std::string& text) {
  const DeviceChoice choice = parse_device(text);
  return choice.kind == "tcp" && tcp_address(choice.serial);
}

std::unique_ptr<hal::Transport> open_tcp(const std::string& device) {
  const auto [host, port] = tcp_address(parse_device(device).serial).value();
  auto opened = hal::usbip::open_device(host, port);
  if (const auto* problem = std::get_if<hal::DeviceProblem>(&opened)) fail(device, *problem);
  return std::move(std::get<std::unique_ptr<hal::Transport>>(opened));
}

}  // namespace

DeviceChoice parse_device(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

CLI::Validator is_device() {
  return {[](const std::string& text) -> std::string {
            const std::string kind = parse_device(text).kind;
            const bool known = text == "mock" || text == "mouse" || text == "spacemouse" ||
                               kind == "usb" || kind == "falcon" || is_tcp(text);
            return known ? "" : "unknown device '" + text + "'";
          },
          "DEVICE"};
}

void fail(const std::string& device, const hal::DeviceProblem& problem) {
  throw Failure(kDevice, "device failed at " + problem.phase + ", " + problem.cause, device,
                problem.fix);
}

std::unique_ptr<hal::Transport> open_usb(const std::string& device, hal::usb::Kind kind) {
  auto opened = hal::usb::open_transport(kind, parse_device(device).serial);
  if (const auto* problem = std::get_if<hal::DeviceProblem>(&opened)) fail(device, *problem);
  return std::move(std::get<std::unique_ptr<hal::Transport>>(opened));
}

std::unique_ptr<hal::Device> make_usb_device(const std::string& device,
                                             const std::filesystem::path& firmware,
                                             const std::vector<hal::protocol::ImageHash>& images,
                                             hal::Clock& clock, int fifo_priority) {
  std::unique_ptr<hal::Driver> driver;
  auto kind = hal::usb::Kind::open_protocol;
  if (parse_device(device).kind == "falcon") {
    kind = hal::usb::Kind::falcon;
    driver = std::make_unique<hal::falcon::FalconDriver>(read_firmware(firmware));
  } else {
    driver = std::make_unique<hal::protocol::HostDriver>(images);
  }
  hal::StreamOptions options;
  options.fifo_priority = fifo_priority;
  auto transport = parse_device(device).kind == "tcp" ? open_tcp(device) : open_usb(device, kind);
  return std::make_unique<hal::StreamedDevice>(std::move(transport), std::move(driver), clock,
                                               options);
}

}  // namespace palpate::cli

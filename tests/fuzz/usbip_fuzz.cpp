// SPDX-License-Identifier: Apache-2.0
// A USB/IP client that says anything, in pieces of any size.
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/simulator/open_device.hpp"
#include "hal/usbip/session.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace palpate::hal::usbip {
namespace {

constexpr std::uint64_t kMs = 1'000'000;
constexpr std::size_t kMaxOutput = 1u << 22;

/// The request that takes the device: without it hardly an input gets any further.
void import(Session& session) {
  auto head = encode(Operation{kVersion, Code::import_request});
  std::array<std::byte, kBusIdBytes> bus_id{std::byte{'1'}, std::byte{'-'}, std::byte{'1'}};
  if (!session.receive(head) || !session.receive(bus_id)) __builtin_trap();
}

void talk(std::span<const std::byte> bytes) {
  simulator::OpenDevice device{{}};
  ExportedDevice exported{device};
  Session session(exported);
  std::uint64_t now_ns = kMs;
  if (!bytes.empty() && (bytes[0] & std::byte{1}) != std::byte{0}) import(session);
  while (!bytes.empty()) {
    const std::size_t wanted = 1 + std::to_integer<std::size_t>(bytes[0]);
    const auto piece = bytes.first(wanted < bytes.size() ? wanted : bytes.size());
    bytes = bytes.subspan(piece.size());
    device.advance_to(now_ns);
    if (!session.receive(piece)) return;
    session.serve();
    if (session.output().size() > kMaxOutput) __builtin_trap();
    now_ns += kMs;
  }
}

}  // namespace
}  // namespace palpate::hal::usbip

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::hal::usbip::talk(std::as_bytes(std::span(data, size)));
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "hal/flash/update.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "hal/flash/dfu.hpp"
#include "hal/protocol/host_driver.hpp"

namespace palpate::hal::flash {
namespace {

constexpr std::uint32_t kTimeout_ms = 1000;

std::string slot_name(std::uint8_t slot) { return slot == 0 ? "A" : "B"; }

}  // namespace

std::optional<DeviceProblem> read_target(Transport& exchange, UpdateTarget& out) {
  using protocol::PacketType;
  if (auto bad =
          protocol::read_descriptor(exchange, PacketType::capabilities, 0, out.capabilities)) {
    return bad;
  }
  if (out.capabilities.slots == 0) {
    return DeviceProblem{"descriptors", "the device has no slots for images",
                         "use one that computes contacts itself, or no flashing"};
  }
  return protocol::read_descriptor(exchange, PacketType::image_identity, 0, out.image);
}

std::variant<std::uint8_t, DeviceProblem> choose_slot(const UpdateTarget& target,
                                                      std::size_t image_bytes,
                                                      std::optional<std::uint8_t> wanted) {
  const std::uint32_t capacity = target.capabilities.image_capacity_bytes;
  if (image_bytes > capacity) {
    return DeviceProblem{"size",
                         "the image has " + std::to_string(image_bytes) + " bytes, a slot " +
                             std::to_string(capacity),
                         "bake again with --max-bytes " + std::to_string(capacity)};
  }
  const std::uint8_t active = target.image.active_slot;
  const std::uint8_t slot = wanted.value_or(active == 0 ? 1 : 0);
  if (slot != active) return slot;
  return DeviceProblem{"slot", "slot " + slot_name(slot) + " is in use",
                       "leave --slot out, or choose the other one"};
}

std::optional<DeviceProblem> write_slot(Transport& update, Clock& clock, std::uint8_t slot,
                                        std::span<const std::byte> image,
                                        const StageProgress& progress) {
  DfuFunctions functions;
  if (auto bad = read_functions(update, functions)) return bad;
  if (const IoStatus io = update.select_alternate(slot); io != IoStatus::ok) {
    return DeviceProblem{"select slot " + slot_name(slot), describe(io),
                         "update the device's firmware to docs/PROTOCOL.md"};
  }
  if (auto bad = download(update, functions, clock, image,
                          [&](double share) { progress("write", share); })) {
    return bad;
  }
  std::vector<std::byte> held;
  auto bad = upload(update, functions, image.size(), held,
                    [&](double share) { progress("read back", share); });
  if (!bad && std::equal(held.begin(), held.end(), image.begin(), image.end())) {
    return std::nullopt;
  }
  if (auto stays = discard(update, functions, clock)) return stays;
  if (bad) return bad;
  return DeviceProblem{"read back", "the device holds something else than was written",
                       "it keeps its old image; run the command again"};
}

std::optional<DeviceProblem> restart(Transport& exchange) {
  const ControlRequest request{protocol::kVendorOut,
                               static_cast<std::uint8_t>(protocol::Request::restart), 0,
                               exchange.interface_number()};
  const IoResult result = exchange.control_out(request, {}, kTimeout_ms);
  if (result.ok()) return std::nullopt;
  return DeviceProblem{"restart", describe(result.status),
                       "the image is written; switch the device off and on"};
}

}  // namespace palpate::hal::flash

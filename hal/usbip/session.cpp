// SPDX-License-Identifier: Apache-2.0
#include "hal/usbip/session.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace palpate::hal::usbip {
namespace {

constexpr std::uint32_t kRefused = 1;

bool is_bus_id(std::span<const std::byte> bytes) {
  std::array<std::byte, kBusIdBytes> right{};
  std::transform(kBusId.begin(), kBusId.end(), right.begin(),
                 [](char c) { return static_cast<std::byte>(c); });
  return std::equal(bytes.begin(), bytes.end(), right.begin(), right.end());
}

std::int32_t status_of(const IoResult& result) { return result.ok() ? kDone : kStalled; }

}  // namespace

Session::~Session() {
  if (!attached_) return;
  exported_.taken = false;
  exported_.device.bus_reset();
}

bool Session::receive(std::span<const std::byte> bytes) {
  input_.insert(input_.end(), bytes.begin(), bytes.end());
  std::size_t at = 0;
  while (!broken_) {
    const auto rest = std::span<const std::byte>(input_).subspan(at);
    const std::size_t taken = attached_ ? take_transfer(rest) : take_operation(rest);
    if (taken == 0) break;
    at += taken;
  }
  input_.erase(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(at));
  return !broken_;
}

std::size_t Session::take_operation(std::span<const std::byte> bytes) {
  if (bytes.size() < kOperationBytes) return 0;
  const Operation operation = decode_operation(bytes.first<kOperationBytes>());
  const bool is_import = operation.code == Code::import_request;
  if (operation.version != kVersion || (!is_import && operation.code != Code::list_request)) {
    broken_ = true;
    return 0;
  }
  if (!is_import) {
    list();
    return kOperationBytes;
  }
  if (bytes.size() < kOperationBytes + kBusIdBytes) return 0;
  import(bytes.subspan(kOperationBytes, kBusIdBytes));
  return kOperationBytes + kBusIdBytes;
}

void Session::list() {
  const bool listed = exported_.to_be_had();
  const std::byte devices{static_cast<std::uint8_t>(listed ? 1 : 0)};
  say(encode(Operation{kVersion, Code::list_reply, 0}));
  say(std::array{std::byte{0}, std::byte{0}, std::byte{0}, devices});
  if (listed) say(describe(exported_.device.descriptors(), true));
}

void Session::import(std::span<const std::byte> bus_id) {
  if (!exported_.to_be_had() || !is_bus_id(bus_id)) {
    say(encode(Operation{kVersion, Code::import_reply, kRefused}));
    return;
  }
  take();
  say(encode(Operation{kVersion, Code::import_reply, 0}));
  say(describe(exported_.device.descriptors(), false));
}

void Session::take() {
  exported_.taken = attached_ = true;
  exported_.device.bus_reset();
}

std::size_t Session::take_transfer(std::span<const std::byte> bytes) {
  if (bytes.size() < kTransferHeaderBytes) return 0;
  TransferHeader header;
  const bool is_request = decode(bytes.first<kTransferHeaderBytes>(), header) &&
                          (header.command == Command::submit || header.command == Command::unlink);
  if (!is_request || header.length > kMaxTransferBytes) {
    broken_ = true;
    return 0;
  }
  if (header.command == Command::unlink) {
    unlink(header);
    return kTransferHeaderBytes;
  }
  const std::size_t follows = header.is_in ? 0 : header.length;
  if (bytes.size() < kTransferHeaderBytes + follows) return 0;
  submit(header, bytes.subspan(kTransferHeaderBytes, follows));
  return kTransferHeaderBytes + follows;
}

void Session::submit(const TransferHeader& header, std::span<const std::byte> data) {
  if (header.endpoint == 0) return control(header, data);
  const auto address = static_cast<std::uint8_t>(header.endpoint | (header.is_in ? 0x80u : 0u));
  if (!has_endpoint(exported_.device.descriptors(), address)) {
    return reply(header.sequence, kStalled, 0, {});
  }
  if (!header.is_in) {
    exported_.device.out(data);
    return reply(header.sequence, kDone, data.size(), {});
  }
  if (waiting_.size() == kMaxPending) {
    broken_ = true;
    return;
  }
  waiting_.push_back({header.sequence, header.length});
  serve();
}

void Session::control(const TransferHeader& header, std::span<const std::byte> data) {
  const Setup setup = decode_setup(header.setup);
  const bool is_in = (setup.request.type & 0x80) != 0;
  const bool agrees = setup.length <= header.length && (is_in == header.is_in || setup.length == 0);
  if (!agrees) return reply(header.sequence, kStalled, 0, {});
  if (!is_in) {
    const IoResult result =
        exported_.device.control_out(setup.request, data.first(std::size_t{setup.length}));
    return reply(header.sequence, status_of(result), result.ok() ? setup.length : 0u, {});
  }
  std::vector<std::byte> bytes(setup.length);
  const IoResult result = exported_.device.control_in(setup.request, bytes);
  const std::size_t moved = result.ok() && header.is_in ? result.bytes : 0;
  reply(header.sequence, status_of(result), moved, std::span(bytes).first(moved));
}

void Session::unlink(const TransferHeader& header) {
  const auto victim = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& waiting) {
    return waiting.sequence == header.victim;
  });
  TransferHeader answer;
  answer.command = Command::unlink_reply;
  answer.sequence = header.sequence;
  // One that is not there has been answered already.
  answer.status = victim == waiting_.end() ? kDone : kUnlinked;
  if (victim != waiting_.end()) waiting_.erase(victim);
  say(encode(answer));
}

void Session::serve() {
  std::array<std::byte, 512> packet;
  while (!waiting_.empty()) {
    const std::size_t length = exported_.device.in(packet);
    if (length == 0) return;
    const Waiting next = waiting_.front();
    waiting_.pop_front();
    const std::size_t moved = std::min(length, next.room);
    reply(next.sequence, length > next.room ? kOverflow : kDone, moved,
          std::span<const std::byte>(packet).first(moved));
  }
}

void Session::reply(std::uint32_t sequence, std::int32_t status, std::size_t moved,
                    std::span<const std::byte> data) {
  TransferHeader answer;
  answer.command = Command::submit_reply;
  answer.sequence = sequence;
  answer.status = status;
  answer.length = static_cast<std::uint32_t>(moved);
  say(encode(answer));
  say(data);
}

void Session::say(std::span<const std::byte> bytes) {
  output_.insert(output_.end(), bytes.begin(), bytes.end());
}

}  // namespace palpate::hal::usbip

// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/ftdi.hpp"

#include <algorithm>
#include <array>

namespace palpate::hal::falcon {
namespace {

constexpr std::uint32_t kTimeout_ms = 500;
/// A transfer without payload comes with every tick of the latency timer, 16 ms at most.
constexpr std::uint32_t kReadTimeout_ms = 50;
constexpr int kMaxEmptyReads = 4;

}  // namespace

std::size_t strip_status(std::span<std::byte> transfer) noexcept {
  std::size_t kept = 0;
  for (std::size_t at = 0; at < transfer.size(); at += kUsbPacketBytes) {
    const std::size_t length = std::min(kUsbPacketBytes, transfer.size() - at);
    if (length <= kStatusBytes) continue;
    const auto payload = transfer.subspan(at + kStatusBytes, length - kStatusBytes);
    std::copy(payload.begin(), payload.end(), transfer.begin() + static_cast<std::ptrdiff_t>(kept));
    kept += payload.size();
  }
  return kept;
}

IoStatus FtdiLine::request(FtdiRequest what, std::uint16_t value) {
  const ControlRequest request{kFtdiOut, static_cast<std::uint8_t>(what), value, 0};
  return transport_.control_out(request, {}, kTimeout_ms).status;
}

IoStatus FtdiLine::purge() {
  const IoStatus receiver = request(FtdiRequest::purge, 1);
  return receiver == IoStatus::ok ? request(FtdiRequest::purge, 2) : receiver;
}

IoStatus FtdiLine::set_baud(Baud baud) {
  return request(FtdiRequest::baud, static_cast<std::uint16_t>(baud));
}

IoStatus FtdiLine::set_8n1_without_flow_control() {
  const IoStatus line = request(FtdiRequest::line, 8);
  return line == IoStatus::ok ? request(FtdiRequest::flow_control, 0) : line;
}

IoStatus FtdiLine::set_dtr(bool high) {
  return request(FtdiRequest::modem, high ? 0x0101 : 0x0100);
}

IoStatus FtdiLine::set_rts(bool high) {
  return request(FtdiRequest::modem, high ? 0x0202 : 0x0200);
}

IoStatus FtdiLine::set_latency_ms(std::uint8_t latency_ms) {
  const IoStatus set = request(FtdiRequest::set_latency, latency_ms);
  if (set != IoStatus::ok) return set;
  std::array<std::byte, 1> now{};
  const ControlRequest get{kFtdiIn, static_cast<std::uint8_t>(FtdiRequest::get_latency), 0, 0};
  const IoResult got = transport_.control_in(get, now, kTimeout_ms);
  if (!got.ok()) return got.status;
  return got.bytes == 1 && now[0] == std::byte{latency_ms} ? IoStatus::ok : IoStatus::failed;
}

IoStatus FtdiLine::write(std::span<const std::byte> bytes) {
  const IoResult result = transport_.write(bytes, kTimeout_ms);
  if (!result.ok()) return result.status;
  return result.bytes == bytes.size() ? IoStatus::ok : IoStatus::failed;
}

IoResult FtdiLine::read(std::span<std::byte> out) {
  std::array<std::byte, kTransferBytes> transfer;
  std::size_t filled = 0;
  for (int empty = 0; filled < out.size() && empty < kMaxEmptyReads;) {
    const IoResult result = transport_.read(transfer, kReadTimeout_ms);
    if (!result.ok() && result.status != IoStatus::timed_out) return {result.status, filled};
    const std::size_t payload = strip_status(std::span(transfer).first(result.bytes));
    empty = payload == 0 ? empty + 1 : 0;
    const std::size_t taken = std::min(payload, out.size() - filled);
    std::copy_n(transfer.begin(), taken, out.begin() + static_cast<std::ptrdiff_t>(filled));
    filled += taken;
  }
  return {filled == out.size() ? IoStatus::ok : IoStatus::timed_out, filled};
}

}  // namespace palpate::hal::falcon

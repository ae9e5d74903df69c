// SPDX-License-Identifier: Apache-2.0
#include "hal/flash/dfu_host.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "hal/flash/dfu.hpp"
#include "hal/protocol/bytes.hpp"
#include "hal/text_table.hpp"

namespace palpate::hal::flash {
namespace {

constexpr std::uint32_t kTimeout_ms = 5000;  // some devices erase inside a request
constexpr std::uint64_t kNsPerMs = 1'000'000;
/// Status requests that one step may take. Before each the host waits as long as the device states.
constexpr int kMaxStatusRequests = 1000;
/// A device that states more is in no state to be waited for.
constexpr std::uint32_t kMaxPoll_ms = 600'000;
constexpr std::size_t kMaxConfigBytes = 1024;
constexpr std::size_t kMinTransferBytes = 8;

using Problem = std::optional<DeviceProblem>;

struct Status {
  DfuStatus status = DfuStatus::ok;
  DfuState state = DfuState::idle;
  std::uint32_t poll_ms = 0;
};

const char* text_of(DfuStatus status) {
  return text_in<DfuStatus>(
      {{DfuStatus::ok, "no error"},
       {DfuStatus::target, "an engine for it needs more memory than it has"},
       {DfuStatus::file, "it is not signed with the device's key"},
       {DfuStatus::write, "its flash cannot be written"},
       {DfuStatus::erase, "its flash cannot be erased"},
       {DfuStatus::check_erased, "its flash cannot be erased"},
       {DfuStatus::program, "its flash cannot be written"},
       {DfuStatus::verify, "what arrived is no sound image"},
       {DfuStatus::address, "the slot is in use or too small"},
       {DfuStatus::vendor, "it is older than what the device has confirmed (--counter)"}},
      status, "it reports an error");
}

DeviceProblem problem(const char* phase, const std::string& cause) {
  return {phase, cause,
          "the slot in use is untouched; run the command again, and if it stays try another cable"};
}

IoStatus send(Transport& t, DfuRequest request, std::uint16_t block,
              std::span<const std::byte> data) {
  return t
      .control_out({kDfuOut, static_cast<std::uint8_t>(request), block, t.interface_number()}, data,
                   kTimeout_ms)
      .status;
}

IoStatus get_status(Transport& t, Status& out) {
  std::array<std::byte, kStatusReplyBytes> reply{};
  const IoResult result = t.control_in(
      {kDfuIn, static_cast<std::uint8_t>(DfuRequest::get_status), 0, t.interface_number()}, reply,
      kTimeout_ms);
  if (!result.ok()) return result.status;
  if (result.bytes != reply.size()) return IoStatus::failed;
  const std::span<const std::byte> bytes(reply);
  out.status = DfuStatus{get<std::uint8_t>(bytes, 0)};
  out.poll_ms = get<std::uint32_t>(bytes, 0) >> 8;
  out.state = DfuState{get<std::uint8_t>(bytes, 4)};
  return IoStatus::ok;
}

/// Asks until the device has reached a state.
Problem wait_for(Transport& t, Clock& clock, DfuState wanted, const char* phase,
                 const std::string& where) {
  for (int i = 0; i < kMaxStatusRequests; ++i) {
    Status now;
    if (const IoStatus io = get_status(t, now); io != IoStatus::ok) {
      return problem(phase, where + ": " + describe(io));
    }
    if (now.status != DfuStatus::ok || now.state == DfuState::error) {
      return problem(phase, where + ": " + text_of(now.status));
    }
    if (now.state == wanted) return std::nullopt;
    if (now.poll_ms > kMaxPoll_ms) break;
    clock.sleep_until(clock.now_ns() + std::max(now.poll_ms, 1u) * kNsPerMs);
  }
  return problem(phase, where + ": the device does not get ready");
}

/// From whatever state a program before has left it in.
Problem make_idle(Transport& t) {
  Status now;
  IoStatus io = get_status(t, now);
  if (io == IoStatus::ok && now.state == DfuState::error) {
    io = send(t, DfuRequest::clear_status, 0, {});
  } else if (io == IoStatus::ok && now.state != DfuState::idle) {
    io = send(t, DfuRequest::abort, 0, {});
  }
  if (io == IoStatus::ok) return std::nullopt;
  return problem("begin", describe(io));
}

/// A stall says only that there is an error; the status says which.
std::string reason_of(Transport& t, IoStatus io) {
  Status now;
  if (io != IoStatus::stalled || get_status(t, now) != IoStatus::ok) return describe(io);
  return text_of(now.status);
}

}  // namespace

Problem read_functions(Transport& transport, DfuFunctions& out) {
  constexpr ControlRequest kGetConfiguration{0x80, 0x06, 0x0200, 0};
  constexpr std::uint8_t kInterfaceDescriptor = 4;
  std::array<std::byte, kMaxConfigBytes> config{};
  const IoResult result = transport.control_in(kGetConfiguration, config, kTimeout_ms);
  if (!result.ok()) return problem("descriptors", describe(result.status));
  const auto bytes = std::span<const std::byte>(config).first(result.bytes);
  bool mine = false;
  for (std::size_t at = 0; at + 2 <= bytes.size();) {
    const auto length = get<std::uint8_t>(bytes, at);
    const auto type = get<std::uint8_t>(bytes, at + 1);
    if (length < 2 || at + length > bytes.size()) break;
    if (type == kInterfaceDescriptor && length >= 3) {
      mine = get<std::uint8_t>(bytes, at + 2) == transport.interface_number();
    }
    if (mine && type == kFunctionalDescriptorType && length >= kFunctionalDescriptorBytes) {
      out.attributes = get<std::uint8_t>(bytes, at + 2);
      out.transfer_bytes = get<std::uint16_t>(bytes, at + 5);
      constexpr std::uint8_t kNeeded = kCanDownload | kCanUpload | kManifestationTolerant;
      if ((out.attributes & kNeeded) == kNeeded && out.transfer_bytes >= kMinTransferBytes) {
        return std::nullopt;
      }
      return problem("descriptors", "the device cannot be written, read back and kept in reach");
    }
    at += length;
  }
  return problem("descriptors", "the device has no DFU functional descriptor");
}

Problem download(Transport& transport, const DfuFunctions& functions, Clock& clock,
                 std::span<const std::byte> bytes, const Progress& progress) {
  if (Problem bad = make_idle(transport)) return bad;
  std::uint16_t block = 0;
  for (std::size_t at = 0; at < bytes.size(); at += functions.transfer_bytes) {
    const auto part =
        bytes.subspan(at, std::min<std::size_t>(functions.transfer_bytes, bytes.size() - at));
    const std::string where = "byte " + std::to_string(at) + " of " + std::to_string(bytes.size());
    if (const IoStatus io = send(transport, DfuRequest::download, block++, part);
        io != IoStatus::ok) {
      return problem("write", where + ": " + reason_of(transport, io));
    }
    if (Problem bad = wait_for(transport, clock, DfuState::download_idle, "write", where)) {
      return bad;
    }
    progress(static_cast<double>(at + part.size()) / static_cast<double>(bytes.size()));
  }
  if (const IoStatus io = send(transport, DfuRequest::download, block, {}); io != IoStatus::ok) {
    return problem("commit", reason_of(transport, io));
  }
  return wait_for(transport, clock, DfuState::idle, "commit", "manifestation");
}

Problem upload(Transport& transport, const DfuFunctions& functions, std::size_t max_bytes,
               std::vector<std::byte>& out, const Progress& progress) {
  if (Problem bad = make_idle(transport)) return bad;
  out.clear();
  std::vector<std::byte> part(functions.transfer_bytes);
  for (std::uint16_t block = 0;; ++block) {
    const ControlRequest request{kDfuIn, static_cast<std::uint8_t>(DfuRequest::upload), block,
                                 transport.interface_number()};
    const IoResult result = transport.control_in(request, part, kTimeout_ms);
    if (!result.ok()) {
      return problem("read back", "byte " + std::to_string(out.size()) + ": " +
                                      reason_of(transport, result.status));
    }
    out.insert(out.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(result.bytes));
    if (out.size() > max_bytes)
      return problem("read back", "the device holds more than was written");
    if (result.bytes < part.size()) return std::nullopt;
    progress(static_cast<double>(out.size()) / static_cast<double>(max_bytes));
  }
}

Problem discard(Transport& transport, const DfuFunctions& functions, Clock& clock) {
  if (Problem bad = make_idle(transport)) return bad;
  const std::vector<std::byte> nothing(functions.transfer_bytes);
  if (const IoStatus io = send(transport, DfuRequest::download, 0, nothing); io != IoStatus::ok) {
    return problem("discard", reason_of(transport, io));
  }
  if (Problem bad = wait_for(transport, clock, DfuState::download_idle, "discard", "first block")) {
    return bad;
  }
  const IoStatus io = send(transport, DfuRequest::abort, 0, {});
  return io == IoStatus::ok ? std::nullopt : Problem(problem("discard", describe(io)));
}

}  // namespace palpate::hal::flash

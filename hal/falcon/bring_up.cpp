// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/bring_up.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "hal/falcon/ftdi.hpp"
#include "hal/falcon/messages.hpp"
#include "hal/text_table.hpp"

namespace palpate::hal::falcon {
namespace {

constexpr std::uint8_t kLoaderLatency_ms = 16;
constexpr std::uint8_t kRunLatency_ms = 1;
constexpr std::array kHello{std::byte{0x0a}, std::byte{0x43}, std::byte{0x0d}};
constexpr std::array kHelloReply{std::byte{0x0a}, std::byte{0x44}, std::byte{0x2c},
                                 std::byte{0x0d}};
constexpr std::array kStartUpload{std::byte{0x41}};

/// Why a phase ended.
struct Failure {
  Phase phase;
  std::string cause;
  bool lost = false;    ///< trying again makes no sense
  bool silent = false;  ///< everything works but that no firmware answers
};
using Step = std::optional<Failure>;

/// The first of several requests that fails.
Step check(Phase phase, std::string_view what, std::initializer_list<IoStatus> statuses) {
  for (const IoStatus status : statuses) {
    if (status == IoStatus::ok) continue;
    return Failure{phase, std::string(what) + ": " + describe(status), status == IoStatus::lost};
  }
  return std::nullopt;
}

Step enter_run_mode(FtdiLine& line, Phase phase) {
  if (Step bad = check(phase, "latency timer", {line.set_latency_ms(kRunLatency_ms)})) return bad;
  return check(phase, "line set-up",
               {line.set_8n1_without_flow_control(), line.set_baud(Baud::b1500k), line.purge()});
}

/// Whether firmware runs: a request with the motors off is answered by a sound reply.
Step probe(FtdiLine& line, Phase phase) {
  if (Step bad = enter_run_mode(line, phase)) return bad;
  const Message request = encode(Request{});
  for (int i = 0; i < kProbes; ++i) {
    if (Step bad = check(phase, "request", {line.write(request)})) return bad;
    std::array<std::byte, kMessageBytes> reply{};
    const IoResult result = line.read(reply);
    if (result.status == IoStatus::lost) return check(phase, "reply", {result.status});
    ReplyParser parser;
    if (parser.feed(std::span(reply).first(result.bytes)) > 0) return std::nullopt;
  }
  return Failure{phase, "no firmware answers", false, true};
}

Step enter_loader(FtdiLine& line) {
  const auto step = [](IoStatus status, std::string_view what) {
    return check(Phase::enter_loader, what, {status});
  };
  if (Step bad = step(line.purge(), "purge")) return bad;
  if (Step bad = step(line.set_latency_ms(kLoaderLatency_ms), "latency timer")) return bad;
  if (Step bad = step(line.set_baud(Baud::b9600), "9600 baud")) return bad;
  if (Step bad = step(line.set_8n1_without_flow_control(), "line set-up")) return bad;
  if (Step bad = step(line.set_rts(false), "RTS low")) return bad;
  if (Step bad = step(line.set_dtr(false), "DTR low")) return bad;
  return step(line.set_dtr(true), "DTR high");
}

/// The loader says hello at the first try, or after the resets that a hub has swallowed.
Step hello(FtdiLine& line) {
  for (int i = 0; i < kMaxHellos; ++i) {
    if (Step bad = check(Phase::hello, "request", {line.write(kHello)})) return bad;
    // One byte more than the reply: some hosts see a zero before it.
    std::array<std::byte, kHelloReply.size() + 1> reply{};
    const IoResult result = line.read(std::span(reply).first(kHelloReply.size()));
    if (result.status == IoStatus::lost) return check(Phase::hello, "reply", {result.status});
    std::size_t length = result.bytes;
    if (length == kHelloReply.size() && reply[0] == std::byte{0}) {
      length += line.read(std::span(reply).last(1)).bytes;
    }
    const auto got = std::span<const std::byte>(reply).first(length);
    if (std::search(got.begin(), got.end(), kHelloReply.begin(), kHelloReply.end()) != got.end()) {
      return std::nullopt;
    }
  }
  return Failure{Phase::hello, "the loader does not answer"};
}

Step start_upload(FtdiLine& line) {
  if (Step bad = check(Phase::start_upload, "line set-up",
                       {line.set_dtr(false), line.set_baud(Baud::b140k), line.purge(),
                        line.write(kStartUpload)})) {
    return bad;
  }
  std::array<std::byte, 1> reply{};
  const IoResult result = line.read(reply);
  if (result.ok() && reply == kStartUpload) return std::nullopt;
  return Failure{Phase::start_upload,
                 result.ok() ? "the loader answers something else" : "the loader does not answer",
                 result.status == IoStatus::lost};
}

/// The echo is the only check that the loader offers: it is compared byte for byte.
Step upload(FtdiLine& line, std::span<const std::byte> firmware) {
  for (std::size_t at = 0; at < firmware.size(); at += kMaxPayload) {
    const auto chunk = firmware.subspan(at, std::min(kMaxPayload, firmware.size() - at));
    const std::string where =
        "byte " + std::to_string(at) + " of " + std::to_string(firmware.size());
    if (Step bad = check(Phase::upload, where, {line.write(chunk)})) return bad;
    std::array<std::byte, kMaxPayload> echo{};
    const IoResult result = line.read(std::span(echo).first(chunk.size()));
    if (!result.ok()) return check(Phase::upload, where + ", echo", {result.status});
    const auto differs = std::mismatch(chunk.begin(), chunk.end(), echo.begin()).first;
    if (differs != chunk.end()) {
      return Failure{Phase::upload,
                     "byte " +
                         std::to_string(at + static_cast<std::size_t>(differs - chunk.begin())) +
                         " of " + std::to_string(firmware.size()) + " came back changed"};
    }
  }
  return std::nullopt;
}

Step load(FtdiLine& line, std::span<const std::byte> firmware) {
  if (Step bad = enter_loader(line)) return bad;
  if (Step bad = hello(line)) return bad;
  if (Step bad = start_upload(line)) return bad;
  if (Step bad = upload(line, firmware)) return bad;
  return probe(line, Phase::run);
}

std::string fix_of(Phase phase) {
  constexpr const char* kReplug = "plug the device in again; if it stays, try another USB port";
  constexpr const char* kRestart =
      "unplug its power and its USB cable, wait, plug both in, and try without a hub";
  return text_in<Phase>({{Phase::probe, kReplug},
                         {Phase::enter_loader, kReplug},
                         {Phase::hello, kRestart},
                         {Phase::start_upload, kRestart},
                         {Phase::upload, "try another cable, and a port without a hub"},
                         {Phase::run, "check that the firmware file is one for the Falcon"}},
                        phase, "");
}

DeviceProblem problem_of(const Failure& failure, int attempts) {
  std::string cause = failure.lost ? "the device is gone" : failure.cause;
  if (attempts > 1) cause += " (" + std::to_string(attempts) + " attempts)";
  return {std::string(name(failure.phase)), cause, fix_of(failure.phase)};
}

}  // namespace

std::string_view name(Phase phase) noexcept {
  return text_in<Phase>({{Phase::probe, "probe"},
                         {Phase::enter_loader, "enter loader"},
                         {Phase::hello, "hello"},
                         {Phase::start_upload, "start upload"},
                         {Phase::upload, "upload"},
                         {Phase::run, "run"}},
                        phase, "unknown");
}

std::optional<DeviceProblem> bring_up(Transport& transport, std::span<const std::byte> firmware) {
  FtdiLine line(transport);
  const Step unready = probe(line, Phase::probe);
  if (!unready) return std::nullopt;
  if (!unready->silent) return problem_of(*unready, 1);
  if (firmware.empty()) {
    return DeviceProblem{"probe", "no firmware answers; the device forgets it when it is unplugged",
                         "give the maker's firmware file with --firmware FILE"};
  }
  if (firmware.size() < kMinFirmwareBytes || firmware.size() > kMaxFirmwareBytes) {
    return DeviceProblem{"upload",
                         "the firmware file has " + std::to_string(firmware.size()) + " bytes",
                         "give the maker's firmware file, about 8 kB"};
  }
  Step failed;
  for (int attempt = 1; attempt <= kMaxAttempts; ++attempt) {
    failed = load(line, firmware);
    if (!failed) return std::nullopt;
    if (failed->lost) return problem_of(*failed, attempt);
  }
  return problem_of(*failed, kMaxAttempts);
}

}  // namespace palpate::hal::falcon

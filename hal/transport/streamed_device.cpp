// SPDX-License-Identifier: Apache-2.0
#include "hal/transport/streamed_device.hpp"

#include <pthread.h>
#include <sched.h>

#include <cmath>
#include <utility>

namespace palpate::hal {
namespace {

/// How long the last packet, which ends the force, may take to leave.
constexpr std::uint64_t kFarewellWithin_ns = 50'000'000;
constexpr std::uint64_t kLookEvery_ns = 1'000'000;

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool is_finite(const Wrench& w) { return is_finite(w.force_N) && is_finite(w.torque_Nm); }

/// Takes nothing: what arrives while the exchange ends is of no use any more.
class NullSink final : public StreamSink {
  void received(std::span<const std::byte> /*bytes*/, std::uint64_t /*now_ns*/) noexcept override {}
};

}  // namespace

StreamedDevice::StreamedDevice(std::unique_ptr<Transport> transport, std::unique_ptr<Driver> driver,
                               Clock& clock, const StreamOptions& options)
    : transport_(std::move(transport)),
      driver_(std::move(driver)),
      clock_(clock),
      options_(options) {}

StreamedDevice::~StreamedDevice() { stop(); }

Capabilities StreamedDevice::capabilities() const noexcept { return driver_->capabilities(); }

std::optional<DeviceProblem> StreamedDevice::open() {
  auto problem = driver_->bring_up(*transport_);
  open_ = !problem;
  return problem;
}

std::optional<DeviceProblem> StreamedDevice::start() {
  if (!open_) return DeviceProblem{"start", "the device is not open", "open it first"};
  if (streaming_) return std::nullopt;
  if (auto problem = driver_->begin(*transport_)) return problem;
  if (const IoStatus status = transport_->begin_stream(); status != IoStatus::ok) {
    driver_->end(*transport_);
    return DeviceProblem{"start", describe(status), "plug the device in again"};
  }
  streaming_ = true;
  forget_last_run();
  if (options_.threaded) thread_ = std::thread([this] { run(); });
  if (wait_for_first_reading()) return std::nullopt;
  const bool lost = (faults() & kDeviceLost) != 0;
  stop();  // only then the driver is ours again
  if (lost) return DeviceProblem{"first reading", "the device is gone", "plug it in again"};
  return driver_->why_no_reading();
}

/// While neither thread runs, both ends of the mailboxes are ours.
void StreamedDevice::forget_last_run() noexcept {
  static_cast<void>(states_.read(state_));
  static_cast<void>(commands_.read(command_));
  state_ = {};
  command_ = {};
  commanded_ = false;
  broken_ = kNoDeviceFault;
  faults_ = kNoDeviceFault;
  readings_ = 0;
  stopping_ = false;
}

bool StreamedDevice::wait_for_first_reading() noexcept {
  const auto patience_ns =
      static_cast<std::uint64_t>(std::llround(1e9 * driver_->first_reading_within_s()));
  const std::uint64_t give_up_ns = clock_.now_ns() + patience_ns;
  while (readings_.load(std::memory_order_relaxed) == 0) {
    const std::uint64_t now_ns = clock_.now_ns();
    if ((faults() & kDeviceLost) != 0 || now_ns >= give_up_ns) return false;
    if (options_.threaded) {
      clock_.sleep_until(now_ns + kLookEvery_ns);
    } else {
      step();
    }
  }
  return true;
}

void StreamedDevice::stop() noexcept {
  if (!streaming_) return;
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
  say_farewell();
  transport_->end_stream();
  driver_->end(*transport_);
  streaming_ = false;
}

bool StreamedDevice::step() noexcept {
  if (transport_->wait(clock_.now_ns() + kPollPeriod_ns, *this) == IoStatus::lost) {
    publish_fault(kDeviceLost);
    return false;
  }
  send_due();
  return true;
}

void StreamedDevice::run() noexcept {
  if (options_.fifo_priority > 0) {
    sched_param parameter{};
    parameter.sched_priority = options_.fifo_priority;
    // Refused without the right to it; the run then keeps worse time and reports it.
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  }
  while (!stopping_.load(std::memory_order_relaxed) && step()) {
  }
}

void StreamedDevice::received(std::span<const std::byte> bytes, std::uint64_t now_ns) noexcept {
  if (!driver_->received(bytes, now_ns, state_)) return;
  // What has broken down stays broken down, however sound this reading is.
  state_.faults |= broken_;
  faults_.fetch_or(state_.faults, std::memory_order_relaxed);
  states_.write(state_);
  readings_.fetch_add(1, std::memory_order_relaxed);
}

void StreamedDevice::take_command(std::uint64_t now_ns) noexcept {
  fresh_ = commands_.read(command_);
  if (fresh_ && !is_finite(command_.wrench)) publish_fault(kDeviceBadCommand);
  const bool expired = now_ns >= command_.expires_ns;
  if (commanded_ && expired) publish_fault(kDeviceSilenced);
  commanded_ = fresh_ ? !expired : commanded_ && !expired;
  constexpr std::uint32_t kNoMoreForce = kDeviceSilenced | kDeviceBadCommand;
  if ((broken_ & kNoMoreForce) == 0) return;
  command_ = {};
  commanded_ = false;
}

void StreamedDevice::send_due() noexcept {
  const std::uint64_t now_ns = clock_.now_ns();
  take_command(now_ns);
  OutBuffer buffer;
  const std::size_t bytes = driver_->poll(command_, fresh_, now_ns, buffer);
  if (bytes > 0 && !transport_->submit(std::span(buffer).first(bytes))) {
    crowded_out_.fetch_add(1, std::memory_order_relaxed);
  }
  if (const std::uint32_t broken = driver_->faults(now_ns); broken != kNoDeviceFault) {
    publish_fault(broken);
  }
}

void StreamedDevice::publish_fault(std::uint32_t faults) noexcept {
  if ((broken_ & faults) == faults) return;
  broken_ |= faults;
  faults_.fetch_or(faults, std::memory_order_relaxed);
  // The last reading again, with its own time and sequence: the loop learns of the fault at once
  // and does not take the pose for a new one.
  state_.faults |= faults;
  states_.write(state_);
}

void StreamedDevice::say_farewell() noexcept {
  NullSink nobody;
  OutBuffer buffer;
  const std::uint64_t until_ns = clock_.now_ns() + kFarewellWithin_ns;
  bool queued = false;
  while (clock_.now_ns() < until_ns) {
    // The pool may still be under way with older commands; the last word must follow them.
    if (!queued) queued = transport_->submit(std::span(buffer).first(driver_->farewell(buffer)));
    if (queued && transport_->pending() == 0) return;
    if (transport_->wait(clock_.now_ns() + kPollPeriod_ns, nobody) == IoStatus::lost) return;
  }
}

}  // namespace palpate::hal

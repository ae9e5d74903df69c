// SPDX-License-Identifier: Apache-2.0
#include "hal/simulator/port.hpp"

#include <algorithm>
#include <utility>

namespace palpate::hal::simulator {
namespace {

constexpr std::uint64_t kNsPerMs = 1'000'000;

}  // namespace

Port::Port(SimulatedDevice& device, Clock& clock, PortFaults faults)
    : device_(device),
      clock_(clock),
      faults_(std::move(faults)),
      start_ns_(clock.now_ns()),
      times_left_(device.presence().times_left),
      lost_(false) {
  if (device.presence().on_bus) return;
  device.advance_to(start_ns_);
  lost_ = !device.presence().on_bus;
}

IoResult Port::control_in(const ControlRequest& request, std::span<std::byte> out,
                          std::uint32_t /*timeout_ms*/) {
  live_to(clock_.now_ns());
  return lost_ ? IoResult{IoStatus::lost} : device_.control_in(request, out);
}

IoResult Port::control_out(const ControlRequest& request, std::span<const std::byte> data,
                           std::uint32_t /*timeout_ms*/) {
  live_to(clock_.now_ns());
  return lost_ ? IoResult{IoStatus::lost} : device_.control_out(request, data);
}

IoStatus Port::select_alternate(std::uint8_t setting) {
  // As the host's stack does it: the standard request SET_INTERFACE.
  return control_out({0x01, 0x0b, setting, interface_number()}, {}, 0).status;
}

IoResult Port::read(std::span<std::byte> out, std::uint32_t timeout_ms) {
  class FirstOnly final : public StreamSink {
   public:
    explicit FirstOnly(std::span<std::byte> to) : to_(to) {}
    void received(std::span<const std::byte> bytes, std::uint64_t /*now_ns*/) noexcept override {
      length = std::min(bytes.size(), to_.size());
      std::copy_n(bytes.begin(), length, to_.begin());
      came = true;
    }
    bool came = false;
    std::size_t length = 0;

   private:
    std::span<std::byte> to_;
  } first(out);
  const IoStatus status = wait(clock_.now_ns() + timeout_ms * kNsPerMs, first);
  if (status != IoStatus::ok) return {status};
  return first.came ? IoResult{IoStatus::ok, first.length} : IoResult{IoStatus::timed_out};
}

IoResult Port::write(std::span<const std::byte> data, std::uint32_t /*timeout_ms*/) {
  if (!submit(data)) return {lost_ ? IoStatus::lost : IoStatus::timed_out};
  return {IoStatus::ok, data.size()};
}

IoStatus Port::begin_stream() {
  live_to(clock_.now_ns());
  return lost_ ? IoStatus::lost : IoStatus::ok;
}

bool Port::submit(std::span<const std::byte> data) {
  const std::uint64_t now_ns = clock_.now_ns();
  live_to(now_ns);
  if (lost_ || pending_ == kOutTransfers || data.size() > kMaxTransferBytes) return false;
  if (hold_out_) {
    ++pending_;
    return true;
  }
  Transfer transfer{};
  transfer.length = data.size();
  std::copy(data.begin(), data.end(), transfer.bytes.begin());
  spoil(transfer, seconds(now_ns), faults_.out);
  out_line_.push(transfer, seconds(now_ns), now_ns, faults_.out);
  live_to(now_ns);
  return true;
}

IoStatus Port::wait(std::uint64_t until_ns, StreamSink& sink) {
  while (true) {
    const std::uint64_t now_ns = clock_.now_ns();
    live_to(now_ns);
    if (lost_) return IoStatus::lost;
    if (const auto transfer = in_line_.pop(now_ns)) {
      sink.received(std::span(transfer->bytes).first(transfer->length), now_ns);
      return IoStatus::ok;
    }
    if (now_ns >= until_ns) return IoStatus::ok;
    const std::uint64_t event_ns =
        std::min({device_.next_event_ns(), in_line_.next_ns(), out_line_.next_ns()});
    clock_.sleep_until(std::clamp(event_ns, now_ns + 1, until_ns));
  }
}

void Port::end_stream() noexcept {
  pending_ = 0;
  in_line_.clear();
  out_line_.clear();
}

/// Device and lines up to now: what has arrived at the device, what it has sent.
void Port::live_to(std::uint64_t now_ns) {
  const double t_s = seconds(now_ns);
  if (!lost_ && !is_plugged(t_s)) {
    lost_ = true;
    device_.bus_reset();
  }
  device_.advance_to(now_ns);
  lost_ = lost_ || device_.presence().times_left != times_left_;
  if (lost_) return;
  while (const auto transfer = out_line_.pop(now_ns)) {
    device_.out(std::span(transfer->bytes).first(transfer->length));
  }
  if (!hold_out_) pending_ = 0;
  Transfer transfer{};
  // A device has one transfer ready at a time; the next one it makes is for later.
  while ((transfer.length = device_.in(transfer.bytes)) > 0) {
    spoil(transfer, t_s, faults_.in);
    in_line_.push(transfer, t_s, now_ns, faults_.in);
  }
}

bool Port::is_plugged(double t_s) {
  return faults_.in.hit(mock::FaultKind::unplug, t_s) == nullptr &&
         faults_.out.hit(mock::FaultKind::unplug, t_s) == nullptr;
}

double Port::seconds(std::uint64_t now_ns) const noexcept {
  return 1e-9 * static_cast<double>(now_ns - start_ns_);
}

void Port::spoil(Transfer& transfer, double t_s, mock::Faults& faults) {
  if (const mock::FaultWindow* w = faults.hit(mock::FaultKind::truncate, t_s)) {
    transfer.length -= std::min(transfer.length, static_cast<std::size_t>(w->amount));
  }
  if (const mock::FaultWindow* w = faults.hit(mock::FaultKind::corrupt, t_s)) {
    for (int i = 0; i < static_cast<int>(w->amount) && transfer.length > 0; ++i) {
      const auto change = static_cast<unsigned>(1 + faults.random() % 255);
      transfer.bytes[faults.random() % transfer.length] ^= static_cast<std::byte>(change);
    }
  }
}

}  // namespace palpate::hal::simulator

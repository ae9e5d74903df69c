// SPDX-License-Identifier: Apache-2.0
#include "hal/usb/libusb_transport.hpp"

#include <algorithm>
#include <utility>

#include "hal/clock.hpp"

namespace palpate::hal::usb {
namespace {

constexpr std::uint64_t kNsPerUs = 1000;
constexpr std::uint64_t kNsPerSecond = 1'000'000'000;
constexpr std::uint64_t kEndWithin_ns = kNsPerSecond;

IoStatus status_of(int libusb_error) noexcept {
  switch (libusb_error) {
    case LIBUSB_SUCCESS:
      return IoStatus::ok;
    case LIBUSB_ERROR_TIMEOUT:
      return IoStatus::timed_out;
    case LIBUSB_ERROR_PIPE:
      return IoStatus::stalled;
    case LIBUSB_ERROR_NO_DEVICE:
      return IoStatus::lost;
    default:
      return IoStatus::failed;
  }
}

IoResult result_of(int length_or_error) noexcept {
  if (length_or_error < 0) return {status_of(length_or_error)};
  return {IoStatus::ok, static_cast<std::size_t>(length_or_error)};
}

std::uint64_t now_ns() noexcept { return MonotonicClock().now_ns(); }

}  // namespace

LibusbTransport::LibusbTransport(Context context, Handle handle, const Interface& interface)
    : context_(std::move(context)), handle_(std::move(handle)), interface_(interface) {
  for (auto* pool : {&in_, &out_}) {
    for (std::size_t i = 0; i < (pool == &in_ ? kInTransfers : kOutTransfers); ++i) {
      auto slot = std::make_unique<Slot>();
      slot->owner = this;
      slot->transfer.reset(libusb_alloc_transfer(0));
      pool->push_back(std::move(slot));
    }
  }
}

LibusbTransport::~LibusbTransport() {
  end_stream();
  libusb_release_interface(handle_.get(), interface_.number);
  // What libusb did not give back within its time may still be written to: it is left to it.
  for (auto* pool : {&in_, &out_}) {
    for (auto& slot : *pool) {
      if (slot->under_way) static_cast<void>(slot.release());
    }
  }
}

IoResult LibusbTransport::control_in(const ControlRequest& request, std::span<std::byte> out,
                                     std::uint32_t timeout_ms) {
  return result_of(libusb_control_transfer(handle_.get(), request.type, request.request,
                                           request.value, request.index,
                                           reinterpret_cast<unsigned char*>(out.data()),
                                           static_cast<std::uint16_t>(out.size()), timeout_ms));
}

IoResult LibusbTransport::control_out(const ControlRequest& request,
                                      std::span<const std::byte> data, std::uint32_t timeout_ms) {
  // libusb's parameter is not const because the other direction writes to it.
  auto* bytes = const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(data.data()));
  return result_of(libusb_control_transfer(handle_.get(), request.type, request.request,
                                           request.value, request.index, bytes,
                                           static_cast<std::uint16_t>(data.size()), timeout_ms));
}

IoStatus LibusbTransport::select_alternate(std::uint8_t setting) {
  return status_of(libusb_set_interface_alt_setting(handle_.get(), interface_.number, setting));
}

IoResult LibusbTransport::read(std::span<std::byte> out, std::uint32_t timeout_ms) {
  return transfer_now(interface_.in_address, interface_.in_type,
                      reinterpret_cast<unsigned char*>(out.data()), out.size(), timeout_ms);
}

IoResult LibusbTransport::write(std::span<const std::byte> data, std::uint32_t timeout_ms) {
  auto* bytes = const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(data.data()));
  return transfer_now(interface_.out_address, interface_.out_type, bytes, data.size(), timeout_ms);
}

IoResult LibusbTransport::transfer_now(std::uint8_t address, std::uint8_t type,
                                       unsigned char* bytes, std::size_t length,
                                       std::uint32_t timeout_ms) {
  int moved = 0;
  const auto transfer =
      type == LIBUSB_TRANSFER_TYPE_BULK ? libusb_bulk_transfer : libusb_interrupt_transfer;
  const int error =
      transfer(handle_.get(), address, bytes, static_cast<int>(length), &moved, timeout_ms);
  if (error == LIBUSB_ERROR_PIPE) libusb_clear_halt(handle_.get(), address);
  return {status_of(error), static_cast<std::size_t>(moved)};
}

IoStatus LibusbTransport::begin_stream() {
  lost_ = false;
  errors_in_a_row_ = 0;
  streaming_ = true;
  for (auto& slot : in_) submit_in(*slot);
  if (!lost_) return IoStatus::ok;
  end_stream();
  return IoStatus::lost;
}

void LibusbTransport::submit_in(Slot& slot) noexcept {
  // One packet a transfer: a longer one would wait for a short packet that never comes.
  const int length = std::min<int>(interface_.in_packet_bytes, kMaxInBytes);
  if (interface_.in_type == LIBUSB_TRANSFER_TYPE_BULK) {
    libusb_fill_bulk_transfer(slot.transfer.get(), handle_.get(), interface_.in_address,
                              slot.bytes.data(), length, on_in, &slot, 0);
  } else {
    libusb_fill_interrupt_transfer(slot.transfer.get(), handle_.get(), interface_.in_address,
                                   slot.bytes.data(), length, on_in, &slot, 0);
  }
  slot.under_way = libusb_submit_transfer(slot.transfer.get()) == 0;
  if (!slot.under_way) lost_ = true;
}

void LibusbTransport::on_in(libusb_transfer* transfer) noexcept {
  Slot& slot = *static_cast<Slot*>(transfer->user_data);
  LibusbTransport& self = *slot.owner;
  slot.under_way = false;
  self.completed_ = 1;
  if (self.note(transfer->status) && self.sink_ != nullptr) {
    self.delivered_ = true;
    const auto length = static_cast<std::size_t>(transfer->actual_length);
    self.sink_->received(std::as_bytes(std::span(slot.bytes).first(length)), now_ns());
  }
  slot.halted = transfer->status == LIBUSB_TRANSFER_STALL;
  if (self.streaming_ && !self.lost_ && !slot.halted) self.submit_in(slot);
}

void LibusbTransport::on_out(libusb_transfer* transfer) noexcept {
  Slot& slot = *static_cast<Slot*>(transfer->user_data);
  slot.under_way = false;
  slot.owner->completed_ = 1;
  slot.owner->note(transfer->status);
  slot.halted = transfer->status == LIBUSB_TRANSFER_STALL;
}

bool LibusbTransport::note(libusb_transfer_status status) noexcept {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      errors_in_a_row_ = 0;
      return true;
    case LIBUSB_TRANSFER_NO_DEVICE:
      lost_ = true;
      return false;
    case LIBUSB_TRANSFER_CANCELLED:
      return false;
    default:
      if (++errors_in_a_row_ >= kErrorsToLost) lost_ = true;
      return false;
  }
}

bool LibusbTransport::submit(std::span<const std::byte> data) {
  if (lost_ || !streaming_ || data.size() > kMaxOutBytes) return false;
  const auto free = std::find_if(
      out_.begin(), out_.end(), [](const auto& slot) { return !slot->under_way && !slot->halted; });
  if (free == out_.end()) return false;
  Slot& slot = **free;
  std::transform(data.begin(), data.end(), slot.bytes.begin(),
                 [](std::byte b) { return std::to_integer<unsigned char>(b); });
  const int length = static_cast<int>(data.size());
  if (interface_.out_type == LIBUSB_TRANSFER_TYPE_BULK) {
    libusb_fill_bulk_transfer(slot.transfer.get(), handle_.get(), interface_.out_address,
                              slot.bytes.data(), length, on_out, &slot, 0);
  } else {
    libusb_fill_interrupt_transfer(slot.transfer.get(), handle_.get(), interface_.out_address,
                                   slot.bytes.data(), length, on_out, &slot, 0);
  }
  slot.under_way = libusb_submit_transfer(slot.transfer.get()) == 0;
  if (!slot.under_way) lost_ = true;
  return slot.under_way;
}

std::size_t LibusbTransport::pending() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(out_.begin(), out_.end(), [](const auto& slot) { return slot->under_way; }));
}

IoStatus LibusbTransport::wait(std::uint64_t until_ns, StreamSink& sink) {
  sink_ = &sink;
  delivered_ = false;
  while (!lost_ && !delivered_) {
    clear_halts();
    const std::uint64_t now = now_ns();
    if (now >= until_ns) {
      handle_events(0);  // what has come meanwhile, without waiting
      break;
    }
    handle_events(until_ns - now);
  }
  sink_ = nullptr;
  return lost_ ? IoStatus::lost : IoStatus::ok;
}

void LibusbTransport::handle_events(std::uint64_t for_ns) noexcept {
  timeval timeout{};
  timeout.tv_sec = static_cast<time_t>(for_ns / kNsPerSecond);
  timeout.tv_usec = static_cast<suseconds_t>(for_ns % kNsPerSecond / kNsPerUs);
  completed_ = 0;
  libusb_handle_events_timeout_completed(context_.get(), &timeout, &completed_);
}

void LibusbTransport::clear_halts() noexcept {
  for (auto& slot : in_) {
    if (!slot->halted) continue;
    libusb_clear_halt(handle_.get(), interface_.in_address);
    slot->halted = false;
    submit_in(*slot);
  }
  for (auto& slot : out_) {
    if (!slot->halted) continue;
    libusb_clear_halt(handle_.get(), interface_.out_address);
    slot->halted = false;
  }
}

bool LibusbTransport::any_under_way() const noexcept {
  const auto under_way = [](const auto& slot) { return slot->under_way; };
  return std::any_of(in_.begin(), in_.end(), under_way) ||
         std::any_of(out_.begin(), out_.end(), under_way);
}

void LibusbTransport::end_stream() noexcept {
  streaming_ = false;
  for (auto* pool : {&in_, &out_}) {
    for (auto& slot : *pool) {
      slot->halted = false;
      if (slot->under_way) libusb_cancel_transfer(slot->transfer.get());
    }
  }
  constexpr std::uint64_t kLookEvery_ns = 10'000'000;
  const std::uint64_t give_up_ns = now_ns() + kEndWithin_ns;
  while (any_under_way() && now_ns() < give_up_ns) handle_events(kLookEvery_ns);
}

}  // namespace palpate::hal::usb

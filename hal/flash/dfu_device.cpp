// SPDX-License-Identifier: Apache-2.0
#include "hal/flash/dfu_device.hpp"

namespace palpate::hal::flash {
namespace {

DfuStatus status_of(UpdateStatus status) noexcept {
  switch (status) {
    case UpdateStatus::ok:
      return DfuStatus::ok;
    case UpdateStatus::in_use:
    case UpdateStatus::too_large:
      return DfuStatus::address;
    case UpdateStatus::not_begun:
      return DfuStatus::not_done;
    case UpdateStatus::erase_failed:
      return DfuStatus::erase;
    case UpdateStatus::write_failed:
      return DfuStatus::program;
    case UpdateStatus::not_an_image:
      return DfuStatus::verify;
    case UpdateStatus::not_signed:
      return DfuStatus::file;
    case UpdateStatus::outdated:
      return DfuStatus::vendor;
    case UpdateStatus::too_demanding:
      return DfuStatus::target;
  }
  return DfuStatus::unknown;
}

}  // namespace

DfuAnswer DfuDevice::handle(const DfuSetup& setup, std::span<const std::byte> data,
                            std::size_t wanted) noexcept {
  switch (setup.request) {
    case DfuRequest::get_status:
      return get_status();
    case DfuRequest::get_state:
      reply_[0] = static_cast<std::byte>(state_);
      return {false, std::span(reply_).first(1)};
    case DfuRequest::clear_status:
      if (state_ != DfuState::error) return fail(DfuStatus::stalled);
      give_up();
      return {};
    case DfuRequest::abort:
      if (state_ == DfuState::error) return fail(status_);
      give_up();
      return {};
    case DfuRequest::download:
      return download(setup.block, data);
    case DfuRequest::upload:
      return upload(setup.block, wanted);
    default:
      return fail(DfuStatus::stalled);
  }
}

DfuAnswer DfuDevice::download(std::uint16_t block, std::span<const std::byte> data) noexcept {
  if (data.size() > kTransferBytes) return fail(DfuStatus::stalled);
  if (state_ == DfuState::idle && !data.empty() && block == 0) {
    next_block_ = 0;
    const UpdateStatus begun = slots_.begin(slot_);
    if (begun != UpdateStatus::ok) return fail(status_of(begun));
  } else if (state_ != DfuState::download_idle) {
    return fail(DfuStatus::stalled);
  }
  // Blocks count past 65535; a lost or repeated one is noticed all the same.
  if (!data.empty() && block != next_block_++) return fail(DfuStatus::address);
  block_bytes_ = data.size();
  for (std::size_t i = 0; i < block_bytes_; ++i) block_[i] = data[i];
  state_ = data.empty() ? DfuState::manifest_sync : DfuState::download_sync;
  has_work_ = true;
  return {};
}

std::uint32_t DfuDevice::erasures() const noexcept {
  return block_bytes_ > 0 ? slots_.erasures_before(block_bytes_) : 0;
}

bool DfuDevice::work() noexcept {
  if (!has_work_) return false;
  if (erasures() > 0) {
    const UpdateStatus erased = slots_.erase_next();
    if (erased != UpdateStatus::ok) fail(status_of(erased));
    return has_work_;
  }
  has_work_ = false;
  const UpdateStatus done =
      block_bytes_ > 0 ? slots_.write(std::span(block_).first(block_bytes_)) : slots_.finish();
  if (done != UpdateStatus::ok) fail(status_of(done));
  return false;
}

std::uint32_t DfuDevice::step_ms() const noexcept {
  if (!has_work_) return 0;
  if (erasures() > 0) return times_.erase_ms;
  return block_bytes_ > 0 ? times_.write_ms : times_.check_ms;
}

std::uint32_t DfuDevice::poll_ms() const noexcept {
  if (!has_work_) return 0;
  return erasures() * times_.erase_ms + (block_bytes_ > 0 ? times_.write_ms : times_.check_ms);
}

DfuAnswer DfuDevice::upload(std::uint16_t block, std::size_t wanted) noexcept {
  if (state_ == DfuState::idle && block == 0) {
    next_block_ = 0;
    uploaded_ = 0;
    image_ = slots_.state(slot_).file;
    state_ = DfuState::upload_idle;
  }
  if (state_ != DfuState::upload_idle || wanted > kTransferBytes) {
    return fail(DfuStatus::stalled);
  }
  if (block != next_block_++) return fail(DfuStatus::address);
  const std::size_t left = image_.size() - uploaded_;
  const std::size_t length = left < wanted ? left : wanted;
  const auto bytes = image_.subspan(uploaded_, length);
  uploaded_ += length;
  // A short block is the last one.
  if (length < wanted) state_ = DfuState::idle;
  return {false, bytes};
}

DfuAnswer DfuDevice::get_status() noexcept {
  if (state_ == DfuState::download_sync || state_ == DfuState::download_busy) {
    state_ = has_work_ ? DfuState::download_busy : DfuState::download_idle;
  } else if (state_ == DfuState::manifest_sync || state_ == DfuState::manifest) {
    state_ = has_work_ ? DfuState::manifest : DfuState::idle;
  }
  reply_ = {};
  // The status, and three bytes of poll time behind it.
  put(reply_, 0, poll_ms() << 8 | static_cast<std::uint32_t>(status_));
  reply_[4] = static_cast<std::byte>(state_);
  return {false, reply_};
}

void DfuDevice::select(std::uint8_t slot) noexcept {
  give_up();
  slot_ = slot;
}

void DfuDevice::bus_reset() noexcept {
  give_up();
  slot_ = 0;
}

DfuAnswer DfuDevice::fail(DfuStatus status) noexcept {
  slots_.abort();
  has_work_ = false;
  state_ = DfuState::error;
  status_ = status;
  return {true, {}};
}

void DfuDevice::give_up() noexcept {
  slots_.abort();
  has_work_ = false;
  state_ = DfuState::idle;
  status_ = DfuStatus::ok;
}

}  // namespace palpate::hal::flash

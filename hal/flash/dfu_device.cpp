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
  if (data.empty()) {
    state_ = DfuState::manifest_sync;
    return {};
  }
  // Blocks count past 65535; a lost or repeated one is noticed all the same.
  if (block != next_block_++) return fail(DfuStatus::address);
  return settle(slots_.write(data), DfuState::download_sync);
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
  // Writing is done within the download itself: there is nothing to wait for.
  if (state_ == DfuState::download_sync) state_ = DfuState::download_idle;
  if (state_ == DfuState::manifest_sync) static_cast<void>(settle(slots_.finish(), DfuState::idle));
  reply_ = {};
  reply_[0] = static_cast<std::byte>(status_);
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

DfuAnswer DfuDevice::settle(UpdateStatus status, DfuState next) noexcept {
  if (status != UpdateStatus::ok) return fail(status_of(status));
  state_ = next;
  return {};
}

DfuAnswer DfuDevice::fail(DfuStatus status) noexcept {
  slots_.abort();
  state_ = DfuState::error;
  status_ = status;
  return {true, {}};
}

void DfuDevice::give_up() noexcept {
  slots_.abort();
  state_ = DfuState::idle;
  status_ = DfuStatus::ok;
}

}  // namespace palpate::hal::flash

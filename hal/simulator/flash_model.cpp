// SPDX-License-Identifier: Apache-2.0
#include "hal/simulator/flash_model.hpp"

namespace palpate::hal::simulator {
namespace {

using flash::kErased;
constexpr std::size_t kAlignment = 64;

}  // namespace

FlashModel::FlashModel(const flash::SlotLayout& layout, std::uint64_t seed)
    : layout_(layout),
      size_(layout.flash_bytes()),
      memory_(size_ + kAlignment, kErased),
      written_(size_, false),
      random_(seed) {
  const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
  aligned_ = (kAlignment - address % kAlignment) % kAlignment;
}

bool FlashModel::erase(std::uint32_t offset) noexcept {
  if (offset % layout_.erase_bytes != 0 || offset >= size_) {
    misused_ = true;
    return false;
  }
  if (steps_left_ == 0) return false;
  bool whole = true;
  for (std::uint64_t i = 0; i < kStepsPerErase; ++i) whole = step() && whole;
  for (std::size_t at = offset; at < offset + layout_.erase_bytes; ++at) {
    std::byte& b = memory_[aligned_ + at];
    if (!whole) {
      const std::uint64_t fate = random();
      if (fate % 4 == 0) continue;
      // Half erased: nothing may be written before it is erased again.
      b = fate % 4 == 1 ? kErased : static_cast<std::byte>(fate >> 8 & 0xff);
      written_[at] = true;
    } else {
      b = kErased;
      written_[at] = false;
    }
  }
  ++erasures_;
  return whole;
}

bool FlashModel::program(std::uint32_t offset, std::span<const std::byte> bytes) noexcept {
  if (offset % flash::kProgramBytes != 0 || bytes.size() % flash::kProgramBytes != 0 ||
      offset + bytes.size() > size_) {
    misused_ = true;
    return false;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool on = steps_left_ > 0;
    if (!on) return false;
    const bool whole = step();
    const std::size_t at = offset + i;
    if (written_[at]) misused_ = true;
    std::byte& b = memory_[aligned_ + at];
    // Writing clears bits; the byte under way keeps some of them.
    b &= whole ? bytes[i] : bytes[i] | static_cast<std::byte>(random() & 0xff);
    // One that kept all of them cannot be told from one that was never begun.
    written_[at] = whole || b != kErased;
    if (!whole) return false;
  }
  return true;
}

/// False for the step in which the power goes.
bool FlashModel::step() noexcept {
  if (steps_left_ == 0) return false;
  ++steps_;
  if (steps_left_ == kForever) return true;
  return --steps_left_ > 0;
}

std::uint64_t FlashModel::random() noexcept {
  random_ ^= random_ << 13;
  random_ ^= random_ >> 7;
  random_ ^= random_ << 17;
  return random_;
}

}  // namespace palpate::hal::simulator

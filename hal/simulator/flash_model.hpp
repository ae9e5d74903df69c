// SPDX-License-Identifier: Apache-2.0
// Flash as a model: bytes are written once between erasures, and the power can be cut inside any
// operation at any byte.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "hal/flash/slots.hpp"

namespace palpate::hal::simulator {

class FlashModel final : public flash::FlashMemory {
 public:
  explicit FlashModel(const flash::SlotLayout& layout, std::uint64_t seed = 1);

  /// A cut in the middle leaves each byte of the unit as it was, erased, or with bits at random.
  bool erase(std::uint32_t offset) noexcept override;
  /// A cut in the middle leaves the bytes before it written and, in the one under way, some of its
  /// bits.
  bool program(std::uint32_t offset, std::span<const std::byte> bytes) noexcept override;
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept override {
    return {memory_.data() + aligned_, size_};
  }

  /// After so many steps the power is off: nothing happens any more and every call fails. A byte
  /// written is one step, an erasure kStepsPerErase.
  void cut_power_after(std::uint64_t steps) noexcept { steps_left_ = steps; }
  void restore_power() noexcept { steps_left_ = kForever; }
  [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }
  static constexpr std::uint64_t kStepsPerErase = 4;

  /// Something was written that was not erased, or beyond the flash: a mistake of the firmware.
  [[nodiscard]] bool misused() const noexcept { return misused_; }
  /// How often units were erased.
  [[nodiscard]] std::uint64_t erasures() const noexcept { return erasures_; }

 private:
  static constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();
  bool step() noexcept;
  std::uint64_t random() noexcept;

  flash::SlotLayout layout_;
  std::size_t size_;
  std::vector<std::byte> memory_;
  std::size_t aligned_ = 0;  ///< where the flash begins in it
  std::vector<bool> written_;
  std::uint64_t steps_left_ = kForever;
  std::uint64_t steps_ = 0;
  std::uint64_t erasures_ = 0;
  std::uint64_t random_;
  bool misused_ = false;
};

}  // namespace palpate::hal::simulator

// SPDX-License-Identifier: Apache-2.0
// A number in flash that only grows, whenever the power is cut: the least security counter that a
// device still accepts. Freestanding.
//
// Two erase units hold entries of one program unit each; the greatest sound one counts. A full unit
// goes on in the other one, whose entries are all lower, so that erasing it loses nothing.
#pragma once

#include <cstdint>

#include "hal/flash/flash_memory.hpp"

namespace palpate::hal::flash {

inline constexpr std::uint32_t kCounterUnits = 2;

class Counter {
 public:
  /// @param offset  of the first of its erase units  @param erase_bytes  of one
  Counter(FlashMemory& flash, std::uint32_t offset, std::uint32_t erase_bytes) noexcept
      : flash_(flash), offset_(offset), erase_bytes_(erase_bytes) {}

  /// 0 where nothing was written yet. Cost: one pass over its units.
  [[nodiscard]] std::uint64_t value() const noexcept;

  /// From now on value() is at least this. False where the flash refused: then it is what it was.
  [[nodiscard]] bool raise(std::uint64_t value) noexcept;

 private:
  [[nodiscard]] std::uint64_t value_in(std::uint32_t unit) const noexcept;
  /// Where the next entry of a unit goes; its end where it is full.
  [[nodiscard]] std::uint32_t first_free(std::uint32_t unit) const noexcept;

  FlashMemory& flash_;
  std::uint32_t offset_;
  std::uint32_t erase_bytes_;
};

}  // namespace palpate::hal::flash

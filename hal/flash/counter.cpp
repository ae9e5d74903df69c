// SPDX-License-Identifier: Apache-2.0
#include "hal/flash/counter.hpp"

namespace palpate::hal::flash {
namespace {

constexpr std::uint64_t kMagic = 0x544e4f43504c4150;  // "PALPCONT"

}  // namespace

std::uint64_t Counter::value() const noexcept {
  const std::uint64_t a = value_in(0), b = value_in(1);
  return a > b ? a : b;
}

std::uint64_t Counter::value_in(std::uint32_t unit) const noexcept {
  const auto bytes = flash_.bytes().subspan(offset_ + unit * erase_bytes_, erase_bytes_);
  std::uint64_t greatest = 0;
  for (std::size_t at = 0; at + kProgramBytes <= bytes.size(); at += kProgramBytes) {
    Entry entry{kMagic};
    if (entry.read(bytes.subspan(at, kProgramBytes)) && entry.first > greatest) {
      greatest = entry.first;
    }
  }
  return greatest;
}

std::uint32_t Counter::first_free(std::uint32_t unit) const noexcept {
  const std::uint32_t begin = offset_ + unit * erase_bytes_;
  const auto bytes = flash_.bytes();
  // From the end: an entry is free only where nothing was begun behind it either.
  std::uint32_t free = begin + erase_bytes_;
  while (free > begin && all_are(bytes.subspan(free - kProgramBytes, kProgramBytes), kErased)) {
    free -= static_cast<std::uint32_t>(kProgramBytes);
  }
  return free;
}

bool Counter::raise(std::uint64_t value) noexcept {
  const std::uint64_t a = value_in(0), b = value_in(1);
  if (value <= a || value <= b) return true;
  std::uint32_t unit = b > a ? 1 : 0;
  std::uint32_t at = first_free(unit);
  if (at == offset_ + (unit + 1) * erase_bytes_) {
    unit = 1 - unit;
    at = offset_ + unit * erase_bytes_;
    if (!flash_.erase(at)) return false;
  }
  return flash_.program(at, Entry{kMagic, value}.bytes());
}

}  // namespace palpate::hal::flash

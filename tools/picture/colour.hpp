// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of pictures and of exported meshes.
#pragma once

#include <cmath>
#include <cstdint>

namespace palpate::picture {

/// sRGB, three bytes in this order.
struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};
static_assert(sizeof(Rgb) == 3);

inline constexpr Rgb kWhite{255, 255, 255};
inline constexpr Rgb kBlack{0, 0, 0};

/// A colour for the index-th thing of many: neighbouring indices get colours far apart, none of
/// them dark. Knuth's multiplicative hash (The Art of Computer Programming, volume 3, Sec. 6.4).
constexpr Rgb colour_of(std::uint32_t index) {
  const std::uint32_t mixed = (index + 1) * 2654435761u;
  const auto channel = [mixed](unsigned shift) {
    return static_cast<std::uint8_t>(80 + (mixed >> shift) % 176);
  };
  return {channel(24), channel(14), channel(4)};
}

/// Each channel times `factor`, in [0, 1].
inline Rgb dimmed(Rgb colour, double factor) {
  const auto channel = [factor](std::uint8_t c) {
    return static_cast<std::uint8_t>(std::lround(factor * c));
  };
  return {channel(colour.r), channel(colour.g), channel(colour.b)};
}

}  // namespace palpate::picture

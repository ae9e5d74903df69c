// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures in a few colours: a third of the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/picture/raster.hpp"

namespace palpate::picture {

struct Indexed {
  std::vector<Rgb> palette;           ///< 1 to kMaxPalette
  std::vector<std::uint8_t> indices;  ///< into palette, one a pixel, row after row
};

inline constexpr std::size_t kMaxPalette = 256;

/// Exactly the raster's colours where there are no more than kMaxPalette. Else the colours are
/// split in two again and again, always the set that deviates most in one channel, at its mean
/// there, and each set becomes its mean. (P. Heckbert, Color Image Quantization for Frame Buffer
/// Display, 1982, splits at the median of the longest side.) O(pixels log pixels + kMaxPalette *
/// colours).
[[nodiscard]] Indexed indexed(const Raster& raster);

}  // namespace palpate::picture

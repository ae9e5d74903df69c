// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures as text, so that tests can show the pixels they expect.
#pragma once

#include <string>

#include "tools/picture/raster.hpp"

namespace palpate::picture::testing {

inline constexpr Rgb kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255};

/// A letter a pixel, a line a row: r, g, b, k (black), . (white), ? (anything else).
inline std::string as_text(const Raster& raster) {
  std::string text;
  for (int y = 0; y < raster.height; ++y) {
    for (int x = 0; x < raster.width; ++x) {
      const Rgb c = raster.at(x, y);
      text += c == kRed     ? 'r'
              : c == kGreen ? 'g'
              : c == kBlue  ? 'b'
              : c == kBlack ? 'k'
              : c == kWhite ? '.'
                            : '?';
    }
    text += '\n';
  }
  return text;
}

}  // namespace palpate::picture::testing

// SPDX-License-Identifier: GPL-3.0-or-later
// Short captions in a built-in font.
#pragma once

#include <string_view>

#include "tools/picture/raster.hpp"

namespace palpate::picture {

// Pixels of one letter with the gap after it, for scale 1; two of the rows are below the line.
inline constexpr int kLetterWidth = 6;
inline constexpr int kLetterHeight = 9;

/// Writes the line in black, its upper left corner at (left, top), each dot of a letter `scale`
/// pixels wide. The font has a to z, 0 to 9, full stop and comma; all else is a gap. What is
/// outside the raster is cut off.
void draw_text(Raster& raster, int left, int top, int scale, std::string_view line);

}  // namespace palpate::picture

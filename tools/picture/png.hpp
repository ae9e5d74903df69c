// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures as PNG files, by libpng.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/picture/raster.hpp"

namespace palpate::picture {

/// The bytes of a PNG file in at most kMaxPalette colours (indexed.hpp), sRGB. Throws
/// std::runtime_error where libpng fails.
[[nodiscard]] std::vector<std::byte> to_png(const Raster& raster);

}  // namespace palpate::picture

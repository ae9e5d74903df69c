// SPDX-License-Identifier: GPL-3.0-or-later
// An image's figures as text for people: `inspect`, `bake`.
#pragma once

#include <string>

#include "rt_core/image/view.hpp"

namespace palpate::cli {

/// The header, the figures of the paper's Table 2, and a row a level. Ends with a line break.
/// Lengths of pieces and levels are for radius 1.
std::string image_text(const ImageView& image);

/// The row of the paper's Table 2 with its head.
std::string table_2_text(const ImageView& image);

}  // namespace palpate::cli

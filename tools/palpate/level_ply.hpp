// SPDX-License-Identifier: GPL-3.0-or-later
// A level of an image as a mesh that can be looked at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rt_core/image/view.hpp"

namespace palpate::cli {

/// Binary little-endian PLY, body coordinates in metres (double), each piece in a colour of its
/// own: the pieces' patches, or on free levels their hulls. Pieces share no vertices.
/// @param level  < image.levels.size()
std::vector<std::byte> level_ply(const ImageView& image, std::uint32_t level);

}  // namespace palpate::cli

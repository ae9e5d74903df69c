// SPDX-License-Identifier: GPL-3.0-or-later
// The levels of an image side by side in one picture.
#pragma once

#include <cstdint>
#include <vector>

#include "rt_core/geometry/vec3.hpp"
#include "rt_core/image/view.hpp"
#include "tools/picture/raster.hpp"

namespace palpate::cli {

/// The levels that are shown, ascending, each once: the finest one; a third and two thirds of the
/// way to the coarsest simplified one, and that; of the free ones one half way up, and the root.
std::vector<std::uint32_t> shown_levels(const ImageView& image);

/// These levels, three a row, all from the same direction and at the same scale, each with a
/// caption: level, triangles, pieces, r. Every piece has the colour that level_ply() gives it; the
/// original surface is plain, for its pieces are too small to be told apart.
/// @param levels  at least one; each < image.levels.size()
/// @param from    direction from the object to the viewer, in body axes; finite, not zero
picture::Raster level_picture(const ImageView& image, const std::vector<std::uint32_t>& levels,
                              Vec3d from);

}  // namespace palpate::cli

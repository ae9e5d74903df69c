// SPDX-License-Identifier: GPL-3.0-or-later
// A level of an image as one mesh.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rt_core/geometry/vec3.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::cli {

/// The pieces' patches, or on free levels their hulls. Pieces share no vertices.
struct LevelMesh {
  std::vector<Vec3f> points;                        ///< for radius 1, about the object's centre
  std::vector<std::uint32_t> piece_of_point;        ///< into ImageView::pieces
  std::vector<std::array<std::uint32_t, 3>> faces;  ///< counter-clockwise seen from outside
};

/// @param level  < image.levels.size()
LevelMesh level_mesh(const ImageView& image, std::uint32_t level);

/// One piece alone. @param piece  < image.pieces.size()
LevelMesh piece_mesh(const ImageView& image, std::uint32_t piece);

}  // namespace palpate::cli

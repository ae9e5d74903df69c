// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies of a report's 3D view: one level of each image, and the pieces that contacts lie on.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "rt_core/geometry/vec3.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::cli {

/// Triangles of a body's level at most: 24 bytes each.
inline constexpr std::uint32_t kMaxShapeTriangles = 20'000;
/// Triangles of the pieces of one body at most: 36 bytes each.
inline constexpr std::size_t kMaxPieceTriangles = 60'000;

/// One level of an image, its vertices shared.
struct Shape {
  std::uint32_t level = 0;    ///< of the image
  std::vector<Vec3f> points;  ///< for radius 1, about the object's centre
  std::vector<std::array<std::uint32_t, 3>> faces;
};

/// The finest level with at most `most` triangles, or the coarsest that is not free, or the last.
Shape shape_of(const ImageView& image, std::uint32_t most = kMaxShapeTriangles);

/// Pieces, each the triangles of its patch or, on free levels, of its hull.
struct PieceShapes {
  std::vector<std::uint32_t> pieces;  ///< indices into the image's, often shown ones first
  std::vector<std::uint32_t> starts;  ///< [pieces + 1] into corners / 3
  std::vector<Vec3f> corners;         ///< three a triangle, for radius 1
  std::map<std::uint32_t, std::uint32_t> place;  ///< of each piece in `pieces`
};

/// Those of `wanted` that fit into `most` triangles together; often shown ones come first.
/// @param wanted  piece: how often it is shown; all < image.pieces.size()
PieceShapes piece_shapes(const ImageView& image,
                         const std::map<std::uint32_t, std::uint32_t>& wanted,
                         std::size_t most = kMaxPieceTriangles);

}  // namespace palpate::cli

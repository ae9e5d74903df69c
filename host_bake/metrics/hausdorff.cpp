// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/hausdorff.hpp"

#include <algorithm>
#include <span>

#include "host_bake/base/parallel.hpp"
#include "host_bake/base/round_up.hpp"
#include "host_bake/metrics/hull_side.hpp"

namespace palpate::bake {

float largest_distance(std::span<const PointF> points, std::span<const PointF> hull_points,
                       std::span<const std::array<std::uint32_t, 3>> faces, int dimension) {
  const HullSide side(hull_points, faces, dimension);
  double largest = 0;
  for (const PointF& p : points) largest = std::max(largest, side.distance(p));
  return rounded_up(largest * (1 + 1e-12));  // the rounding of the distance itself
}

std::vector<float> hausdorff_bounds(const Hierarchy& tree) {
  std::vector<float> bound(tree.pieces.size(), 0.0f);
  parallel_for(tree.pieces.size(), [&](std::size_t i) {
    const TreePiece& piece = tree.pieces[i];
    if (piece.enclosing.empty()) return;
    bound[i] = largest_distance(positions(tree, piece.enclosing), hull_points(tree, piece),
                                piece.hull_faces, piece.dimension);
  });
  return bound;
}

}  // namespace palpate::bake

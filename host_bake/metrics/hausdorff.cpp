// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/hausdorff.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "host_bake/base/parallel.hpp"
#include "host_bake/metrics/hull_side.hpp"

namespace palpate::bake {
namespace {

std::span<const std::uint32_t> hull_of(const TreePiece& piece) {
  return {piece.vertices.data(), piece.hull_vertices};
}

// Largest distance of the child's hull vertices to the parent's hull.
double directed_distance(const Hierarchy& tree, const TreePiece& child, const TreePiece& parent) {
  std::vector<std::uint32_t> shared(hull_of(parent).begin(), hull_of(parent).end());
  std::sort(shared.begin(), shared.end());
  const std::vector<PointF> points = hull_points(tree, parent);
  std::optional<HullSide> side;  // many parents have all their children's vertices and need none
  double largest = 0;
  for (const std::uint32_t v : hull_of(child)) {
    if (std::binary_search(shared.begin(), shared.end(), v)) continue;
    if (!side) side.emplace(points, parent.hull_faces, parent.dimension);
    largest = std::max(largest, side->distance(tree.points[v]));
  }
  return largest;
}

float rounded_up(double v) {
  if (v <= 0) return 0;
  const double wanted = v * (1 + 1e-12);  // the rounding of the distance itself
  const auto f = static_cast<float>(wanted);
  return static_cast<double>(f) < wanted ? std::nextafter(f, std::numeric_limits<float>::infinity())
                                         : f;
}

}  // namespace

std::vector<float> hausdorff_bounds(const Hierarchy& tree) {
  std::vector<double> to_parent(tree.pieces.size(), 0.0);
  parallel_for(tree.pieces.size(), [&](std::size_t i) {
    const TreePiece& piece = tree.pieces[i];
    if (piece.parent != image::kNone)
      to_parent[i] = directed_distance(tree, piece, tree.pieces[piece.parent]);
  });
  std::vector<double> bound(tree.pieces.size(), 0.0);
  for (std::size_t i = 0; i < tree.pieces.size(); ++i) {  // children come before their parents
    const std::uint32_t parent = tree.pieces[i].parent;
    if (parent != image::kNone) bound[parent] = std::max(bound[parent], bound[i] + to_parent[i]);
  }
  std::vector<float> out(bound.size());
  std::transform(bound.begin(), bound.end(), out.begin(), rounded_up);
  return out;
}

}  // namespace palpate::bake

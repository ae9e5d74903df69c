// SPDX-License-Identifier: GPL-3.0-or-later
// How pieces enclose the pieces of level 0 below them.
#include <algorithm>
#include <vector>

#include "host_bake/metrics/hull_side.hpp"
#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {
namespace {

constexpr double kHausdorffTolerance = 1e-9;

// Hull vertices of the pieces of level 0 below a piece; no repeats.
std::vector<PointF> original_points(const Evidence& evidence, std::uint32_t top) {
  std::vector<PointF> points;
  std::vector<std::uint32_t> stack = {top};
  while (!stack.empty()) {
    const std::uint32_t i = stack.back();
    stack.pop_back();
    const image::Piece& piece = evidence.image.pieces[i];
    for (std::uint32_t c = 0; c < piece.children; ++c) stack.push_back(piece.first_child + c);
    if (piece.children > 0) continue;
    const auto hull = hull_points(evidence, i);
    points.insert(points.end(), hull.begin(), hull.end());
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

bool is_free(const Evidence& evidence, std::uint32_t index) {
  return evidence.image.levels[evidence.image.pieces[index].level].free != 0;
}

// What has to be inside a free piece because of one child: the child's hull stands for what that
// encloses.
std::vector<PointF> below_child(const Evidence& evidence, std::uint32_t child) {
  if (!is_free(evidence, child)) return original_points(evidence, child);
  const auto hull = hull_points(evidence, child);
  return {hull.begin(), hull.end()};
}

std::string not_enclosed(const Evidence& evidence, std::uint32_t index) {
  const image::Piece& piece = evidence.image.pieces[index];
  if (!is_free(evidence, index)) return {};
  const HullMesh& hull = evidence.hulls[index];
  const HullSide side(hull_points(evidence, index), hull.faces, hull.dimension);
  const std::vector<PointF> own = [&] {
    const auto points = hull_points(evidence, index);
    std::vector<PointF> sorted(points.begin(), points.end());
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }();
  for (std::uint32_t c = 0; c < piece.children; ++c) {
    for (const PointF& p : below_child(evidence, piece.first_child + c)) {
      if (!std::binary_search(own.begin(), own.end(), p) && !side.contains(p))
        return "a point below child " + std::to_string(piece.first_child + c) + " is outside";
    }
  }
  return {};
}

std::string beyond(const std::vector<PointF>& points, const std::vector<PointF>& corners,
                   const HullMesh& hull, float bound, const std::string& name) {
  const HullSide side(corners, hull.faces, hull.dimension);
  for (const PointF& p : points) {
    const double distance = side.distance(p);
    if (distance > static_cast<double>(bound) + kHausdorffTolerance) {
      return "a point of level 0 is " + std::to_string(distance) + " outside the " + name +
             " hull, the bound is " + std::to_string(bound);
    }
  }
  return {};
}

std::vector<PointF> culling_points(const ImageView& image, const image::Piece& piece) {
  std::vector<PointF> points;
  for (std::uint32_t i = 0; i < piece.culling_vertices; ++i) {
    const float(&p)[3] = image.culling_vertices[piece.first_culling_vertex + i].position;
    points.push_back({p[0], p[1], p[2]});
  }
  return points;
}

std::string beyond_bounds(const Evidence& evidence, std::uint32_t index) {
  const image::Piece& piece = evidence.image.pieces[index];
  if (is_free(evidence, index) && piece.hausdorff != 0) return "h of a free piece is not 0";
  if (is_free(evidence, index) || piece.children == 0) return {};
  const std::vector<PointF> points = original_points(evidence, index);
  const auto own = hull_points(evidence, index);
  const std::string wrong = beyond(points, {own.begin(), own.end()}, evidence.hulls[index],
                                   piece.hausdorff, "piece's own");
  if (!wrong.empty() || piece.culling_vertices == 0) return wrong;
  const std::vector<PointF> culling = culling_points(evidence.image, piece);
  HullMesh hull = convex_hull(culling);
  if (hull.vertices.size() != culling.size()) return "a culling vertex is not extreme";
  return beyond(points, culling, hull, piece.culling_residual, "culling");
}

}  // namespace

Proof prove_free_levels_enclose(const Evidence& evidence) {
  const std::string invariant = "hulls of free levels enclose level 0";
  if (evidence.image.header->dropped_levels > 0) return not_provable(invariant);
  return prove_each(invariant, evidence.hulls.size(),
                    [&](std::uint32_t i) { return not_enclosed(evidence, i); });
}

Proof prove_hausdorff_bounds(const Evidence& evidence) {
  const std::string invariant = "h and residual bound how far level 0 is outside";
  if (evidence.image.header->dropped_levels > 0) return not_provable(invariant);
  return prove_each(invariant, evidence.hulls.size(),
                    [&](std::uint32_t i) { return beyond_bounds(evidence, i); });
}

}  // namespace palpate::bake

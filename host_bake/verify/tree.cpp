// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces and their parents, levels, and the source they come from.
#include <algorithm>
#include <optional>
#include <vector>

#include "host_bake/metrics/hull_side.hpp"
#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {
namespace {

constexpr double kHausdorffTolerance = 1e-9;

// Hull vertices of the child that are not the parent's too.
std::vector<PointF> foreign_vertices(const Evidence& evidence, std::uint32_t child,
                                     std::uint32_t parent) {
  const std::span<const PointF> of_parent = hull_points(evidence, parent);
  std::vector<PointF> shared(of_parent.begin(), of_parent.end());
  std::sort(shared.begin(), shared.end());
  std::vector<PointF> foreign;
  for (const PointF& p : hull_points(evidence, child)) {
    if (!std::binary_search(shared.begin(), shared.end(), p)) foreign.push_back(p);
  }
  return foreign;
}

// Calls visit(side, point) for each foreign vertex of each child until it returns false.
template <class Visit>
void for_each_foreign_vertex(const Evidence& evidence, std::uint32_t parent, Visit visit) {
  const image::Piece& piece = evidence.image.pieces[parent];
  const HullMesh& hull = evidence.hulls[parent];
  std::optional<HullSide> side;
  for (std::uint32_t c = 0; c < piece.children; ++c) {
    for (const PointF& p : foreign_vertices(evidence, piece.first_child + c, parent)) {
      if (!side) side.emplace(hull_points(evidence, parent), hull.faces, hull.dimension);
      if (!visit(*side, piece.first_child + c, p)) return;
    }
  }
}

std::string not_enclosed(const Evidence& evidence, std::uint32_t parent) {
  if (evidence.image.levels[evidence.image.pieces[parent].level].free == 0) return {};
  std::string wrong;
  for_each_foreign_vertex(
      evidence, parent, [&](const HullSide& side, std::uint32_t child, const PointF& p) {
        if (!side.contains(p))
          wrong = "a hull vertex of child " + std::to_string(child) + " is outside";
        return wrong.empty();
      });
  return wrong;
}

std::string beyond_hausdorff(const Evidence& evidence, std::uint32_t parent) {
  const image::Piece& piece = evidence.image.pieces[parent];
  const auto bound_of = [&](std::uint32_t i) {
    return static_cast<double>(evidence.image.pieces[i].hausdorff);
  };
  for (std::uint32_t c = 0; c < piece.children; ++c) {
    if (bound_of(piece.first_child + c) > bound_of(parent)) return "h is less than a child's";
  }
  std::string wrong;
  for_each_foreign_vertex(evidence, parent,
                          [&](const HullSide& side, std::uint32_t child, const PointF& p) {
                            const double reached = bound_of(child) + side.distance(p);
                            if (reached > bound_of(parent) + kHausdorffTolerance) {
                              wrong = "a descendant may be " + std::to_string(reached) +
                                      " outside, h is " + std::to_string(bound_of(parent));
                            }
                            return wrong.empty();
                          });
  return wrong;
}

std::string deviation_out_of_order(const ImageView& image, std::uint32_t index) {
  const image::Piece& piece = image.pieces[index];
  if (piece.level == 0 && piece.surface_deviation != 0) return "s is not 0 on level 0";
  if (image.levels[piece.level].free != 0) return {};
  for (std::uint32_t c = 0; c < piece.children; ++c) {
    if (image.pieces[piece.first_child + c].surface_deviation > piece.surface_deviation)
      return "s is less than a child's";
  }
  return {};
}

}  // namespace

Proof prove_sources_complete(const Evidence& evidence) {
  const std::string invariant = "every source triangle is in exactly one piece of level 0";
  std::vector<std::uint32_t> uses(evidence.image.header->source_triangles, 0);
  for (const image::Piece& piece : evidence.image.pieces) {
    if (piece.level != 0) continue;
    for (const image::Triangle& t : patch(evidence, piece)) {
      if (t.source >= uses.size())
        return {invariant, false, "no source triangle " + std::to_string(t.source)};
      ++uses[t.source];
    }
  }
  const auto wrong = std::find_if(uses.begin(), uses.end(), [](std::uint32_t n) { return n != 1; });
  if (wrong == uses.end()) return {invariant, true, std::to_string(uses.size()) + " triangles"};
  return {invariant, false,
          "triangle " + std::to_string(wrong - uses.begin()) + " is in " + std::to_string(*wrong) +
              " pieces"};
}

Proof prove_free_levels_enclose(const Evidence& evidence) {
  return prove_each("hulls of free levels enclose their children", evidence.hulls.size(),
                    [&](std::uint32_t i) { return not_enclosed(evidence, i); });
}

Proof prove_hausdorff_bounds(const Evidence& evidence) {
  return prove_each("h bounds how far descendants are outside", evidence.hulls.size(),
                    [&](std::uint32_t i) { return beyond_hausdorff(evidence, i); });
}

Proof prove_deviation_ordered(const Evidence& evidence) {
  return prove_each("s is 0 on level 0 and does not fall upward", evidence.hulls.size(),
                    [&](std::uint32_t i) { return deviation_out_of_order(evidence.image, i); });
}

Proof prove_resolution_ordered(const Evidence& evidence) {
  const std::string invariant =
      "r is positive and does not rise upward, free levels last with none";
  const std::span<const image::Level> levels = evidence.image.levels;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const bool is_free = levels[i].free != 0;
    const bool follows = i == 0 || (levels[i - 1].free <= levels[i].free &&
                                    levels[i - 1].resolution >= levels[i].resolution);
    if (is_free != (levels[i].resolution == 0) || !follows)
      return {invariant, false, "level " + std::to_string(i)};
  }
  for (std::size_t i = 0; i < evidence.image.pieces.size(); ++i) {
    const image::Piece& piece = evidence.image.pieces[i];
    if (piece.resolution != levels[piece.level].resolution) {
      return {invariant, false, "piece " + std::to_string(i) + " has not the r of its level"};
    }
  }
  return {invariant, true, std::to_string(levels.size()) + " levels"};
}

Proof prove_support_areas_positive(const Evidence& evidence) {
  const std::string invariant = "D is positive at every vertex";
  const auto vertices = evidence.image.vertices;
  const auto wrong = std::find_if(vertices.begin(), vertices.end(),
                                  [](const image::Vertex& v) { return !(v.support_area > 0); });
  if (wrong == vertices.end())
    return {invariant, true, std::to_string(vertices.size()) + " vertices"};
  return {invariant, false, "vertex " + std::to_string(wrong - vertices.begin())};
}

}  // namespace palpate::bake

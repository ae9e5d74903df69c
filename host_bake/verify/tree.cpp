// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces and their parents, levels, and the source they come from.
#include <algorithm>
#include <vector>

#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {
namespace {

std::string deviation_out_of_order(const ImageView& image, std::uint32_t index) {
  const image::Piece& piece = image.pieces[index];
  const bool original = piece.level == 0 && image.header->dropped_levels == 0;
  if (original && piece.surface_deviation != 0) return "s is not 0 on the original surface";
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
  if (evidence.image.header->dropped_levels > 0) return not_provable(invariant);
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

Proof prove_deviation_ordered(const Evidence& evidence) {
  return prove_each("s is 0 on the original surface and does not fall upward",
                    evidence.hulls.size(),
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

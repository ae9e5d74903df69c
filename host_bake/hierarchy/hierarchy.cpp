// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hierarchy/hierarchy.hpp"

#include <algorithm>
#include <tuple>

namespace palpate::bake {
namespace {

// `local_of` maps points of the mesh to the patch's; only the entries of this patch's vertices are
// read.
TreePiece piece_of(const Patch& patch, const NormalMesh& mesh,
                   std::vector<std::uint32_t>& local_of) {
  TreePiece piece;
  piece.vertices = patch.vertices;
  piece.hull_vertices = static_cast<std::uint32_t>(patch.hull.vertices.size());
  piece.dimension = patch.hull.dimension;
  piece.hull_faces = patch.hull.faces;
  piece.virtual_faces = patch.virtual_faces;
  piece.all_real = patch.all_real;
  piece.back_open = patch.back_open;
  for (std::uint32_t i = 0; i < patch.vertices.size(); ++i) local_of[patch.vertices[i]] = i;
  piece.triangles.reserve(patch.faces.size());
  for (const std::uint32_t f : patch.faces) {
    const Face& face = mesh.faces[f];
    piece.triangles.push_back({{local_of[face[0]], local_of[face[1]], local_of[face[2]]}, f});
  }
  return piece;
}

}  // namespace

Hierarchy level_zero(const NormalMesh& mesh, const std::vector<Patch>& patches, float resolution) {
  Hierarchy tree;
  tree.points = mesh.points;
  tree.pieces.reserve(2 * patches.size());
  std::vector<std::uint32_t> local_of(mesh.points.size(), image::kNone);
  for (const Patch& patch : patches) tree.pieces.push_back(piece_of(patch, mesh, local_of));
  tree.levels.push_back({.pieces = static_cast<std::uint32_t>(patches.size()),
                         .triangles = static_cast<std::uint32_t>(mesh.faces.size()),
                         .free = false,
                         .resolution = resolution});
  return tree;
}

std::vector<std::uint32_t> top_pieces(const Hierarchy& tree) {
  std::vector<std::uint32_t> top;
  for (std::uint32_t i = 0; i < tree.pieces.size(); ++i) {
    if (tree.pieces[i].parent == image::kNone) top.push_back(i);
  }
  return top;
}

std::vector<PiecePair> edge_neighbours(const Hierarchy& tree,
                                       const std::vector<std::uint32_t>& pieces) {
  struct Side {
    std::uint32_t low, high, position;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  for (std::uint32_t position = 0; position < pieces.size(); ++position) {
    const TreePiece& piece = tree.pieces[pieces[position]];
    for (const image::Triangle& t : piece.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [low, high] =
            std::minmax(piece.vertices[t.vertices[i]], piece.vertices[t.vertices[(i + 1) % 3]]);
        sides.push_back({low, high, position});
      }
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<PiecePair> pairs;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side &a = sides[i - 1], &b = sides[i];
    if (a.low == b.low && a.high == b.high && a.position != b.position)
      pairs.emplace_back(a.position, b.position);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::vector<PointF> hull_points(const Hierarchy& tree, const TreePiece& piece) {
  std::vector<PointF> points(piece.hull_vertices);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = tree.points[piece.vertices[i]];
  return points;
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hierarchy/hierarchy.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "host_bake/base/parallel.hpp"
#include "host_bake/hierarchy/adopt.hpp"

namespace palpate::bake {
namespace {

// `local_of` maps points of the mesh to the patch's; only the entries of this patch's vertices are
// read. `first_point` is where the mesh's points lie in the tree.
TreePiece piece_of(const Patch& patch, const NormalMesh& mesh, std::uint32_t first_point,
                   std::vector<std::uint32_t>& local_of) {
  TreePiece piece;
  piece.vertices = patch.vertices;
  for (std::uint32_t& v : piece.vertices) v += first_point;
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
  for (const Patch& patch : patches) tree.pieces.push_back(piece_of(patch, mesh, 0, local_of));
  tree.levels.push_back({.pieces = static_cast<std::uint32_t>(patches.size()),
                         .triangles = static_cast<std::uint32_t>(mesh.faces.size()),
                         .free = false,
                         .resolution = resolution});
  return tree;
}

void add_level(Hierarchy& tree, const SimplifiedLevel& level) {
  const auto number = static_cast<std::uint32_t>(tree.levels.size());
  const auto first_piece = static_cast<std::uint32_t>(tree.pieces.size());
  const auto first_point = static_cast<std::uint32_t>(tree.points.size());
  const std::uint32_t first_below = first_piece - tree.levels.back().pieces;
  tree.points.insert(tree.points.end(), level.mesh.points.begin(), level.mesh.points.end());

  std::vector<std::uint32_t> local_of(level.mesh.points.size(), image::kNone);
  std::vector<TreePiece> made;
  made.reserve(level.patches.size());
  for (const Patch& patch : level.patches) {
    made.push_back(piece_of(patch, level.mesh, first_point, local_of));
    made.back().level = number;
  }
  const std::vector<std::uint32_t> parents = choose_parents(tree, level);
  for (std::uint32_t below = 0; below < parents.size(); ++below) {
    const std::uint32_t parent = parents[below];
    tree.pieces[first_below + below].parent = first_piece + parent;
    made[parent].children.push_back(first_below + below);
  }
  parallel_for(made.size(), [&](std::size_t i) {
    made[i].enclosing = enclosing_hull(tree, made[i].children).points;
  });
  std::move(made.begin(), made.end(), std::back_inserter(tree.pieces));
  tree.levels.push_back({.pieces = static_cast<std::uint32_t>(level.patches.size()),
                         .triangles = static_cast<std::uint32_t>(level.mesh.faces.size()),
                         .free = false,
                         .resolution = static_cast<float>(level.resolution)});
}

std::span<const std::uint32_t> enclosing_points(const TreePiece& piece) {
  if (!piece.enclosing.empty()) return piece.enclosing;
  return {piece.vertices.data(), piece.hull_vertices};
}

std::vector<std::uint32_t> top_pieces(const Hierarchy& tree) {
  std::vector<std::uint32_t> top;
  for (std::uint32_t i = 0; i < tree.pieces.size(); ++i) {
    if (tree.pieces[i].parent == image::kNone) top.push_back(i);
  }
  return top;
}

std::vector<PiecePair> owners_that_meet(std::vector<OwnedSide> sides) {
  std::sort(sides.begin(), sides.end());
  std::vector<PiecePair> pairs;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const OwnedSide &a = sides[i - 1], &b = sides[i];
    if (a.low == b.low && a.high == b.high && a.owner != b.owner)
      pairs.emplace_back(a.owner, b.owner);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::vector<PiecePair> edge_neighbours(const Hierarchy& tree,
                                       const std::vector<std::uint32_t>& pieces) {
  std::vector<OwnedSide> sides;
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
  return owners_that_meet(std::move(sides));
}

std::vector<PointF> positions(const Hierarchy& tree, std::span<const std::uint32_t> points) {
  std::vector<PointF> out(points.size());
  std::transform(points.begin(), points.end(), out.begin(),
                 [&](std::uint32_t p) { return tree.points[p]; });
  return out;
}

std::vector<PointF> hull_points(const Hierarchy& tree, const TreePiece& piece) {
  return positions(tree, {piece.vertices.data(), piece.hull_vertices});
}

EnclosingHull enclosing_hull(const Hierarchy& tree, std::span<const std::uint32_t> children) {
  std::vector<std::uint32_t> united;
  for (const std::uint32_t c : children) {
    const auto below = enclosing_points(tree.pieces[c]);
    united.insert(united.end(), below.begin(), below.end());
  }
  std::sort(united.begin(), united.end());
  united.erase(std::unique(united.begin(), united.end()), united.end());
  EnclosingHull out{convex_hull(positions(tree, united)), {}};
  for (const std::uint32_t v : out.hull.vertices) out.points.push_back(united[v]);
  return out;
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hierarchy/merge.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "host_bake/base/parallel.hpp"
#include "host_bake/hierarchy/dop.hpp"
#include "host_bake/hierarchy/pairing.hpp"

namespace palpate::bake {
namespace {

TreePiece merged(const Hierarchy& tree, std::uint32_t a, std::uint32_t b, std::uint32_t level) {
  TreePiece piece;
  piece.level = level;
  piece.children = {a, b};
  EnclosingHull enclosing = enclosing_hull(tree, piece.children);
  piece.dimension = enclosing.hull.dimension;
  piece.hull_faces = std::move(enclosing.hull.faces);
  piece.hull_vertices = static_cast<std::uint32_t>(enclosing.points.size());
  piece.vertices = std::move(enclosing.points);
  return piece;
}

// The pieces alive at the level that is made next.
struct Front {
  std::vector<std::uint32_t> pieces;  // into the tree
  std::vector<Dop> bounds;            // of each
  std::vector<PiecePair> neighbours;  // positions in `pieces`
};

Front first_front(const Hierarchy& tree) {
  Front front{top_pieces(tree), {}, {}};
  front.bounds.reserve(front.pieces.size());
  for (const std::uint32_t p : front.pieces)
    front.bounds.push_back(dop_of(positions(tree, enclosing_points(tree.pieces[p]))));
  front.neighbours = edge_neighbours(tree, front.pieces);
  return front;
}

// Those left single first, then the merged ones in the order of the pairs.
Front next_front(const Front& front, const std::vector<PiecePair>& pairs,
                 std::uint32_t first_merged) {
  Front next;
  std::vector<std::uint32_t> new_position(front.pieces.size(), image::kNone);
  const auto singles = static_cast<std::uint32_t>(front.pieces.size() - 2 * pairs.size());
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    new_position[pairs[i].first] = new_position[pairs[i].second] = singles + i;
  }
  for (std::uint32_t i = 0; i < front.pieces.size(); ++i) {
    if (new_position[i] != image::kNone) continue;
    new_position[i] = static_cast<std::uint32_t>(next.pieces.size());
    next.pieces.push_back(front.pieces[i]);
    next.bounds.push_back(front.bounds[i]);
  }
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    next.pieces.push_back(first_merged + i);
    next.bounds.push_back(united(front.bounds[pairs[i].first], front.bounds[pairs[i].second]));
  }
  for (const auto& [a, b] : front.neighbours) {
    if (new_position[a] != new_position[b])
      next.neighbours.push_back(std::minmax(new_position[a], new_position[b]));
  }
  std::sort(next.neighbours.begin(), next.neighbours.end());
  next.neighbours.erase(std::unique(next.neighbours.begin(), next.neighbours.end()),
                        next.neighbours.end());
  return next;
}

void check_room_for_level(const Hierarchy& tree) {
  if (tree.levels.size() == image::kMaxLevels) {
    throw InputRefused(
        "the hierarchy needs more than " + std::to_string(image::kMaxLevels) + " levels",
        std::to_string(tree.levels.front().pieces) + " pieces", "simplify the mesh");
  }
}

}  // namespace

void merge_to_root(Hierarchy& tree, const Progress& progress) {
  Front front = first_front(tree);
  const double first_pieces = static_cast<double>(front.pieces.size());
  while (front.pieces.size() > 1) {
    check_room_for_level(tree);
    const std::vector<PiecePair> pairs = pair_up(front.bounds, front.neighbours);
    const auto level = static_cast<std::uint32_t>(tree.levels.size());
    const auto first_merged = static_cast<std::uint32_t>(tree.pieces.size());
    std::vector<TreePiece> made(pairs.size());
    parallel_for(pairs.size(), [&](std::size_t i) {
      made[i] = merged(tree, front.pieces[pairs[i].first], front.pieces[pairs[i].second], level);
    });
    for (std::uint32_t i = 0; i < made.size(); ++i) {
      for (const std::uint32_t c : made[i].children) tree.pieces[c].parent = first_merged + i;
    }
    std::move(made.begin(), made.end(), std::back_inserter(tree.pieces));
    front = next_front(front, pairs, first_merged);
    tree.levels.push_back(
        {.pieces = static_cast<std::uint32_t>(front.pieces.size()), .free = true});
    if (progress)
      progress("merge",
               1 - std::log2(static_cast<double>(front.pieces.size())) / std::log2(first_pieces));
  }
}

}  // namespace palpate::bake

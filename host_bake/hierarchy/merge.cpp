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

TreePiece merged(const Hierarchy& tree, std::vector<std::uint32_t> children, std::uint32_t level) {
  TreePiece piece;
  piece.level = level;
  std::sort(children.begin(), children.end());
  piece.children = std::move(children);
  EnclosingHull enclosing = enclosing_hull(tree, piece.children);
  piece.dimension = enclosing.hull.dimension;
  piece.hull_faces = std::move(enclosing.hull.faces);
  piece.hull_vertices = static_cast<std::uint32_t>(enclosing.points.size());
  piece.vertices = std::move(enclosing.points);
  return piece;
}

// Pieces of the tree that are one on the level that is made next.
using Group = std::vector<std::uint32_t>;

struct Front {
  std::vector<Group> groups;
  std::vector<Dop> bounds;            // of each
  std::vector<PiecePair> neighbours;  // positions in `groups`
};

Front first_front(const Hierarchy& tree) {
  const std::vector<std::uint32_t> pieces = top_pieces(tree);
  Front front;
  front.bounds.reserve(pieces.size());
  for (const std::uint32_t p : pieces) {
    front.groups.push_back({p});
    front.bounds.push_back(dop_of(positions(tree, enclosing_points(tree.pieces[p]))));
  }
  front.neighbours = edge_neighbours(tree, pieces);
  return front;
}

Group united(const Group& a, const Group& b) {
  Group both = a;
  both.insert(both.end(), b.begin(), b.end());
  return both;
}

// Those left single first, then the united ones in the order of the pairs.
Front next_front(const Front& front, const std::vector<PiecePair>& pairs) {
  Front next;
  std::vector<std::uint32_t> new_position(front.groups.size(), image::kNone);
  const auto singles = static_cast<std::uint32_t>(front.groups.size() - 2 * pairs.size());
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    new_position[pairs[i].first] = new_position[pairs[i].second] = singles + i;
  }
  for (std::uint32_t i = 0; i < front.groups.size(); ++i) {
    if (new_position[i] != image::kNone) continue;
    new_position[i] = static_cast<std::uint32_t>(next.groups.size());
    next.groups.push_back(front.groups[i]);
    next.bounds.push_back(front.bounds[i]);
  }
  for (const auto& [a, b] : pairs) {
    next.groups.push_back(united(front.groups[a], front.groups[b]));
    next.bounds.push_back(united(front.bounds[a], front.bounds[b]));
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

// Every group of several pieces becomes a piece of a new level.
void add_free_level(Hierarchy& tree, std::vector<Group>& groups) {
  const auto level = static_cast<std::uint32_t>(tree.levels.size());
  const auto first_merged = static_cast<std::uint32_t>(tree.pieces.size());
  std::vector<Group*> several;
  for (Group& group : groups) {
    if (group.size() > 1) several.push_back(&group);
  }
  std::vector<TreePiece> made(several.size());
  parallel_for(several.size(),
               [&](std::size_t i) { made[i] = merged(tree, std::move(*several[i]), level); });
  for (std::uint32_t i = 0; i < made.size(); ++i) {
    for (const std::uint32_t c : made[i].children) tree.pieces[c].parent = first_merged + i;
    *several[i] = {first_merged + i};
  }
  std::move(made.begin(), made.end(), std::back_inserter(tree.pieces));
  tree.levels.push_back({.pieces = static_cast<std::uint32_t>(groups.size()), .free = true});
}

void check_room_for_level(const Hierarchy& tree) {
  if (tree.levels.size() == image::kMaxLevels) {
    throw InputRefused(
        "the hierarchy needs more than " + std::to_string(image::kMaxLevels) + " levels",
        std::to_string(tree.levels.front().pieces) + " pieces", "simplify the mesh");
  }
}

}  // namespace

void merge_to_root(Hierarchy& tree, const Progress& progress, int rounds) {
  Front front = first_front(tree);
  const double first_pieces = static_cast<double>(front.groups.size());
  while (front.groups.size() > 1) {
    check_room_for_level(tree);
    const bool last = front.groups.size() <= std::size_t{1} << rounds;
    for (int round = 0; (last || round < rounds) && front.groups.size() > 1; ++round) {
      front = next_front(front, pair_up(front.bounds, front.neighbours));
    }
    add_free_level(tree, front.groups);
    if (progress)
      progress("merge",
               1 - std::log2(static_cast<double>(front.groups.size())) / std::log2(first_pieces));
  }
}

}  // namespace palpate::bake

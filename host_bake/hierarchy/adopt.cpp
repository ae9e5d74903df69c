// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hierarchy/adopt.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "host_bake/base/parallel.hpp"
#include "host_bake/hierarchy/dop.hpp"

namespace palpate::bake {
namespace {

std::vector<std::uint32_t> patch_of_face(const SimplifiedLevel& level) {
  std::vector<std::uint32_t> owner(level.mesh.faces.size(), 0);
  for (std::uint32_t p = 0; p < level.patches.size(); ++p) {
    for (const std::uint32_t f : level.patches[p].faces) owner[f] = p;
  }
  return owner;
}

// Patches that share an edge with each patch.
std::vector<std::vector<std::uint32_t>> neighbours(const SimplifiedLevel& level,
                                                   const std::vector<std::uint32_t>& owner) {
  std::vector<OwnedSide> sides;
  sides.reserve(3 * level.mesh.faces.size());
  for (std::uint32_t f = 0; f < level.mesh.faces.size(); ++f) {
    const Face& face = level.mesh.faces[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(face[i], face[(i + 1) % 3]);
      sides.push_back({low, high, owner[f]});
    }
  }
  std::vector<std::vector<std::uint32_t>> lists(level.patches.size());
  for (const auto& [a, b] : owners_that_meet(std::move(sides))) {
    lists[a].push_back(b);
    lists[b].push_back(a);
  }
  return lists;
}

std::vector<Dop> bounds_of_patches(const SimplifiedLevel& level) {
  std::vector<Dop> bounds(level.patches.size());
  parallel_for(bounds.size(), [&](std::size_t p) {
    std::vector<PointF> points;
    for (const std::uint32_t v : level.patches[p].vertices) points.push_back(level.mesh.points[v]);
    bounds[p] = dop_of(points);
  });
  return bounds;
}

double growth(const Dop& parent, const Dop& child) {
  return mean_width(united(parent, child)) - mean_width(parent);
}

// The child of each patch that stays with it: of those merged into it, the one that fits best.
std::vector<std::uint32_t> heirs_kept(const SimplifiedLevel& level,
                                      const std::vector<Dop>& of_patches,
                                      const std::vector<Dop>& of_children) {
  std::vector<std::uint32_t> kept(of_patches.size(), image::kNone);
  std::vector<double> least(of_patches.size(), std::numeric_limits<double>::infinity());
  for (std::uint32_t c = 0; c < of_children.size(); ++c) {
    const std::uint32_t p = level.parent_of_patch[c];
    const double grown = growth(of_patches[p], of_children[c]);
    if (grown >= least[p]) continue;
    least[p] = grown;
    kept[p] = c;
  }
  return kept;
}

// The patch a piece was merged into first, then the others, ascending.
std::vector<std::uint32_t> candidates(const TreePiece& child, std::uint32_t heir,
                                      const SimplifiedLevel& level,
                                      const std::vector<std::uint32_t>& owner,
                                      const std::vector<std::vector<std::uint32_t>>& joined) {
  std::vector<std::uint32_t> near = {heir};
  for (const image::Triangle& t : child.triangles)
    near.push_back(owner[level.face_of_face[t.source]]);
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  std::vector<std::uint32_t> all = near;
  for (const std::uint32_t p : near) all.insert(all.end(), joined[p].begin(), joined[p].end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  all.insert(all.begin(), heir);
  return all;
}

}  // namespace

std::vector<std::uint32_t> choose_parents(const Hierarchy& tree, const SimplifiedLevel& level) {
  const std::uint32_t count = tree.levels.back().pieces;
  const auto first = static_cast<std::uint32_t>(tree.pieces.size()) - count;
  const std::vector<std::uint32_t> owner = patch_of_face(level);
  const auto joined = neighbours(level, owner);
  std::vector<Dop> of_children(count);
  parallel_for(count, [&](std::size_t c) {
    of_children[c] = dop_of(positions(tree, enclosing_points(tree.pieces[first + c])));
  });
  std::vector<Dop> of_patches = bounds_of_patches(level);
  const std::vector<std::uint32_t> kept = heirs_kept(level, of_patches, of_children);
  for (std::size_t p = 0; p < kept.size(); ++p)
    of_patches[p] = united(of_patches[p], of_children[kept[p]]);

  std::vector<std::uint32_t> parents = level.parent_of_patch;
  parallel_for(count, [&](std::size_t c) {
    if (kept[parents[c]] == c) return;
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t best = parents[c];
    for (const std::uint32_t p :
         candidates(tree.pieces[first + c], parents[c], level, owner, joined)) {
      const double grown = growth(of_patches[p], of_children[c]);
      if (grown >= least) continue;
      least = grown;
      best = p;
    }
    parents[c] = best;
  });
  return parents;
}

}  // namespace palpate::bake

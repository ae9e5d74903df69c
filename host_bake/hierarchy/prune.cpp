// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hierarchy/prune.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace palpate::bake {
namespace {

// Largest weighted surface deviation that a contact on the piece can have.
double largest_weighted_deviation(const Hierarchy& tree, const Metrics& metrics, std::size_t index,
                                  double partner_area) {
  const TreePiece& piece = tree.pieces[index];
  const double resolution = static_cast<double>(tree.levels[piece.level].resolution);
  float least_area = image::kMaxArea;
  for (const std::uint32_t v : piece.vertices) {
    least_area = std::min(least_area, metrics.support_area[v]);
  }
  const double phi =
      static_cast<double>(metrics.surface_deviation[index]) / (resolution * resolution);
  return phi / std::max(static_cast<double>(least_area), partner_area);
}

template <class T>
void erase_front(std::vector<T>& v, std::size_t count) {
  v.erase(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

std::optional<float> served_s0(const Hierarchy& tree, const Metrics& metrics, std::uint32_t dropped,
                               float partner_area) {
  if (dropped == 0) return 0.0f;
  if (dropped >= tree.levels.size() || tree.levels[dropped].free) return {};
  double most = static_cast<double>(std::numeric_limits<float>::min());
  for (std::size_t i = 0; i < tree.pieces.size(); ++i) {
    if (tree.pieces[i].level != dropped) continue;
    most = std::max(
        most, largest_weighted_deviation(tree, metrics, i, static_cast<double>(partner_area)));
  }
  return std::nextafter(static_cast<float>(most), std::numeric_limits<float>::infinity());
}

// Simplified levels renew every piece, so the pieces of the levels dropped are the first ones.
void drop_levels(Hierarchy& tree, Metrics& metrics, std::uint32_t dropped) {
  std::uint32_t gone = 0;
  for (std::uint32_t l = 0; l < dropped; ++l) gone += tree.levels[l].pieces;
  erase_front(tree.levels, dropped);
  erase_front(tree.pieces, gone);
  erase_front(metrics.spheres, gone);
  erase_front(metrics.surface_deviation, gone);
  erase_front(metrics.hausdorff, gone);
  erase_front(metrics.culling, gone);
  for (TreePiece& piece : tree.pieces) {
    piece.level -= dropped;
    if (piece.parent != image::kNone) piece.parent -= gone;
    if (piece.level == 0) piece.children.clear();
    for (std::uint32_t& c : piece.children) c -= gone;
  }
}

}  // namespace palpate::bake

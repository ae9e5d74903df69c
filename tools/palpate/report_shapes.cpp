// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_shapes.hpp"

#include <algorithm>
#include <tuple>

#include "tools/palpate/level_mesh.hpp"

namespace palpate::cli {
namespace {

std::uint32_t shown_level(const ImageView& image, std::uint32_t most) {
  std::uint32_t coarsest = static_cast<std::uint32_t>(image.levels.size()) - 1;
  for (std::uint32_t i = 0; i < image.levels.size(); ++i) {
    if (image.levels[i].free != 0) break;
    if (image.levels[i].triangles <= most) return i;
    coarsest = i;
  }
  return coarsest;
}

/// Pieces share no vertices: one is made of all that lie at the same place.
Shape weld(const LevelMesh& mesh) {
  Shape shape;
  std::map<std::tuple<float, float, float>, std::uint32_t> index;
  std::vector<std::uint32_t> joined;
  for (const Vec3f& p : mesh.points) {
    const auto next = static_cast<std::uint32_t>(shape.points.size());
    const auto [at, is_new] = index.try_emplace({p.x, p.y, p.z}, next);
    if (is_new) shape.points.push_back(p);
    joined.push_back(at->second);
  }
  for (const auto& [a, b, c] : mesh.faces) shape.faces.push_back({joined[a], joined[b], joined[c]});
  return shape;
}

}  // namespace

Shape shape_of(const ImageView& image, std::uint32_t most) {
  const std::uint32_t level = shown_level(image, most);
  Shape shape = weld(level_mesh(image, level));
  shape.level = level;
  return shape;
}

PieceShapes piece_shapes(const ImageView& image,
                         const std::map<std::uint32_t, std::uint32_t>& wanted, std::size_t most) {
  std::vector<std::uint32_t> order;
  order.reserve(wanted.size());
  for (const auto& [piece, times] : wanted) order.push_back(piece);
  // What is shown most often must not be what does not fit.
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return wanted.at(a) > wanted.at(b); });
  PieceShapes out;
  out.starts.push_back(0);
  for (const std::uint32_t piece : order) {
    const LevelMesh mesh = piece_mesh(image, piece);
    if (out.corners.size() / 3 + mesh.faces.size() > most) continue;
    for (const auto& face : mesh.faces) {
      for (const std::uint32_t corner : face) out.corners.push_back(mesh.points[corner]);
    }
    out.place.emplace(piece, static_cast<std::uint32_t>(out.pieces.size()));
    out.pieces.push_back(piece);
    out.starts.push_back(static_cast<std::uint32_t>(out.corners.size() / 3));
  }
  return out;
}

}  // namespace palpate::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/verify/evidence.hpp"

#include <algorithm>

#include "host_bake/base/parallel.hpp"

namespace palpate::bake {
namespace {

std::vector<PointF> positions(const ImageView& image, const image::Piece& piece) {
  std::vector<PointF> points;
  points.reserve(piece.vertices);
  for (const image::Vertex& v : image.vertices.subspan(piece.first_vertex, piece.vertices)) {
    points.push_back({v.position[0], v.position[1], v.position[2]});
  }
  return points;
}

HullMesh hull_of(std::span<const PointF> points) {
  HullMesh hull = convex_hull(points);
  for (auto& face : hull.faces) {
    for (std::uint32_t& v : face) v = hull.vertices[v];
  }
  return hull;
}

}  // namespace

Evidence gather(const ImageView& image) {
  Evidence evidence{image, {}, {}};
  evidence.points.resize(image.pieces.size());
  evidence.hulls.resize(image.pieces.size());
  parallel_for(image.pieces.size(), [&](std::size_t i) {
    evidence.points[i] = positions(image, image.pieces[i]);
    evidence.hulls[i] = hull_of(hull_points(evidence, static_cast<std::uint32_t>(i)));
  });
  return evidence;
}

std::span<const PointF> hull_points(const Evidence& evidence, std::uint32_t piece) {
  return std::span(evidence.points[piece]).first(evidence.image.pieces[piece].hull_vertices);
}

std::span<const image::Triangle> patch(const Evidence& evidence, const image::Piece& piece) {
  if (piece.triangles == 0) return {};
  return evidence.image.triangles.subspan(piece.first_triangle, piece.triangles);
}

std::vector<std::uint32_t> alive_at(const ImageView& image, std::uint32_t level) {
  std::vector<std::uint32_t> alive;
  for (std::uint32_t i = 0; i < image.pieces.size(); ++i) {
    const image::Piece& p = image.pieces[i];
    if (p.level <= level && (p.parent == image::kNone || image.pieces[p.parent].level > level))
      alive.push_back(i);
  }
  return alive;
}

Proof not_provable(const std::string& invariant) {
  return {invariant, true, "not provable: the original surface was left out of this image"};
}

Proof prove_each(const std::string& invariant, const Things& things,
                 const std::function<std::string(std::uint32_t)>& check) {
  std::vector<char> fails(things.count, 0);
  parallel_for(things.count, [&](std::size_t i) {
    fails[i] = check(static_cast<std::uint32_t>(i)).empty() ? 0 : 1;
  });
  const auto first = std::find(fails.begin(), fails.end(), 1);
  if (first == fails.end()) {
    return {invariant, true, std::to_string(things.count) + " " + things.many};
  }
  const auto index = static_cast<std::uint32_t>(first - fails.begin());
  return {invariant, false,
          things.one + " " + std::to_string(index) + ": " + check(index) + " (" +
              std::to_string(std::count(first, fails.end(), 1)) + " " + things.many + " fail)"};
}

Proof prove_each(const std::string& invariant, std::size_t pieces,
                 const std::function<std::string(std::uint32_t)>& check) {
  return prove_each(invariant, Things{pieces}, check);
}

}  // namespace palpate::bake

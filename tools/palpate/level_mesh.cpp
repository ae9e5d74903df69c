// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/level_mesh.hpp"

#include <span>

#include "host_bake/hull/hull.hpp"

namespace palpate::cli {
namespace {

bool is_alive(const ImageView& image, const image::Piece& piece, std::uint32_t level) {
  return piece.level <= level &&
         (piece.parent == image::kNone || image.pieces[piece.parent].level > level);
}

void add_face(LevelMesh& mesh, std::uint32_t first, std::uint32_t a, std::uint32_t b,
              std::uint32_t c) {
  mesh.faces.push_back({first + a, first + b, first + c});
}

void add_hull(LevelMesh& mesh, std::uint32_t first, std::span<const image::Vertex> vertices) {
  std::vector<bake::PointF> points;
  for (const image::Vertex& v : vertices) {
    points.push_back({v.position[0], v.position[1], v.position[2]});
  }
  const bake::HullMesh hull = bake::convex_hull(points);
  for (const auto& [a, b, c] : hull.faces) {
    add_face(mesh, first, hull.vertices[a], hull.vertices[b], hull.vertices[c]);
  }
}

void add_piece(LevelMesh& mesh, const ImageView& image, std::uint32_t index) {
  const image::Piece& piece = image.pieces[index];
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  const auto vertices = image.vertices.subspan(piece.first_vertex, piece.vertices);
  for (const image::Vertex& v : vertices) {
    mesh.points.push_back({v.position[0], v.position[1], v.position[2]});
    mesh.piece_of_point.push_back(index);
  }
  for (const image::Triangle& t :
       image.triangles.subspan(piece.triangles > 0 ? piece.first_triangle : 0, piece.triangles)) {
    add_face(mesh, first, t.vertices[0], t.vertices[1], t.vertices[2]);
  }
  if (piece.triangles == 0) add_hull(mesh, first, vertices.first(piece.hull_vertices));
}

}  // namespace

LevelMesh level_mesh(const ImageView& image, std::uint32_t level) {
  LevelMesh mesh;
  for (std::uint32_t i = 0; i < image.pieces.size(); ++i) {
    if (is_alive(image, image.pieces[i], level)) add_piece(mesh, image, i);
  }
  return mesh;
}

LevelMesh piece_mesh(const ImageView& image, std::uint32_t piece) {
  LevelMesh mesh;
  add_piece(mesh, image, piece);
  return mesh;
}

}  // namespace palpate::cli

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/image/checks.hpp"

namespace palpate::image::checks {
namespace {

bool corners_sound(const std::uint32_t (&v)[3], std::uint32_t vertices) noexcept {
  return v[0] < vertices && v[1] < vertices && v[2] < vertices && v[0] != v[1] && v[1] != v[2] &&
         v[2] != v[0];
}

bool source_sound(const Triangle& triangle, const Piece& piece, const Header& header) noexcept {
  return piece.level == 0 && header.dropped_levels == 0 ? triangle.source < header.source_triangles
                                                        : triangle.source == kNone;
}

bool faces_sound(const ImageView& image, const Piece& piece) noexcept {
  for (std::uint32_t i = 0; i < piece.triangles; ++i) {
    const Triangle& triangle = image.triangles[piece.first_triangle + i];
    if (!corners_sound(triangle.vertices, piece.vertices) ||
        !source_sound(triangle, piece, *image.header)) {
      return false;
    }
  }
  for (std::uint32_t i = 0; i < piece.virtual_faces; ++i) {
    const VirtualFace& face = image.virtual_faces[piece.first_virtual_face + i];
    if (!corners_sound(face.vertices, piece.vertices)) return false;
  }
  return true;
}

// No list is empty and none leads out of the hull or to its own vertex, so that hill climbing
// always has a next vertex to look at.
bool list_sound(std::span<const std::uint32_t> list, std::uint32_t vertex,
                std::uint32_t hull_vertices) noexcept {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i] >= hull_vertices || list[i] == vertex || (i > 0 && list[i] <= list[i - 1])) {
      return false;
    }
  }
  return !list.empty();
}

bool adjacency_sound(const ImageView& image, const Piece& piece) noexcept {
  if (piece.hull_vertices <= kAdjacencyAbove) return true;
  const auto starts = image.neighbour_starts.subspan(piece.first_neighbour_start,
                                                     std::size_t{piece.hull_vertices} + 1);
  const auto neighbours = image.neighbours.subspan(piece.first_neighbour, starts.back());
  if (starts.front() != 0) return false;
  for (std::uint32_t v = 0; v < piece.hull_vertices; ++v) {
    const std::uint32_t first = starts[v];
    const std::uint32_t last = starts[v + 1];
    if (last < first || last > neighbours.size() ||
        !list_sound(neighbours.subspan(first, last - first), v, piece.hull_vertices)) {
      return false;
    }
  }
  return true;
}

bool position_sound(const Vertex& vertex) noexcept {
  double squared_norm = 0;
  for (const float c : vertex.position) {
    if (!within(c, -kMaxNorm, kMaxNorm)) return false;
    squared_norm += static_cast<double>(c) * static_cast<double>(c);
  }
  return squared_norm <= static_cast<double>(kMaxNorm) * static_cast<double>(kMaxNorm);
}

// The radius is rounded up, so the slack covers the rounding of these few operations alone.
bool in_sphere(const Vertex& vertex, const Piece& piece) noexcept {
  constexpr double kSlack = 1e-14;
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double d =
        static_cast<double>(vertex.position[axis]) - static_cast<double>(piece.centre[axis]);
    squared += d * d;
  }
  const double radius = static_cast<double>(piece.radius);
  return squared <= radius * radius * (1.0 + kSlack);
}

}  // namespace

Status check_indices(const ImageView& image) noexcept {
  for (const Piece& piece : image.pieces) {
    if (!faces_sound(image, piece) || !adjacency_sound(image, piece)) {
      return Status::image_bad_index;
    }
  }
  return Status::ok;
}

Status check_vertices(const ImageView& image) noexcept {
  for (const Piece& piece : image.pieces) {
    float least_area = kMaxArea;
    for (std::uint32_t i = 0; i < piece.vertices; ++i) {
      const Vertex& vertex = image.vertices[piece.first_vertex + i];
      if (!position_sound(vertex) || !within(vertex.support_area, kMinArea, kMaxArea)) {
        return Status::image_bad_float;
      }
      if (i < piece.hull_vertices && !in_sphere(vertex, piece)) return Status::image_bad_piece;
      if (vertex.support_area < least_area) least_area = vertex.support_area;
    }
    if (least_area != piece.min_support_area) return Status::image_bad_piece;
    for (std::uint32_t i = 0; i < piece.culling_vertices; ++i) {
      const Vertex& vertex = image.culling_vertices[piece.first_culling_vertex + i];
      if (!position_sound(vertex) || vertex.support_area != 0) return Status::image_bad_float;
      if (!in_sphere(vertex, piece)) return Status::image_bad_piece;
    }
  }
  return Status::ok;
}

}  // namespace palpate::image::checks

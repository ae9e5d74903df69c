// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/level_ply.hpp"

#include <array>
#include <span>
#include <string>

#include "host_bake/hull/hull.hpp"

namespace palpate::cli {
namespace {

using Colour = std::array<std::uint8_t, 3>;

// Neighbouring indices get colours far apart, none of them dark.
Colour colour_of(std::uint32_t piece) {
  const std::uint32_t mixed = (piece + 1) * 2654435761u;  // Knuth's multiplicative hash
  const auto channel = [mixed](unsigned shift) {
    return static_cast<std::uint8_t>(80 + (mixed >> shift) % 176);
  };
  return {channel(24), channel(14), channel(4)};
}

bool is_alive(const ImageView& image, const image::Piece& piece, std::uint32_t level) {
  return piece.level <= level &&
         (piece.parent == image::kNone || image.pieces[piece.parent].level > level);
}

class PlyWriter {
 public:
  explicit PlyWriter(const image::Header& header) : header_(header) {}

  void add_piece(const ImageView& image, std::uint32_t index) {
    const image::Piece& piece = image.pieces[index];
    const auto vertices = image.vertices.subspan(piece.first_vertex, piece.vertices);
    for (const image::Vertex& v : vertices) add_vertex(v, colour_of(index));
    for (std::uint32_t i = 0; i < piece.triangles; ++i) {
      add_face(image.triangles[piece.first_triangle + i].vertices);
    }
    if (piece.triangles == 0) add_hull(vertices.first(piece.hull_vertices));
    first_vertex_ += piece.vertices;
  }

  [[nodiscard]] std::vector<std::byte> finish() const {
    const std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(first_vertex_) +
        "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\n"
        "property uchar green\nproperty uchar blue\nelement face " +
        std::to_string(face_count_) + "\nproperty list uchar int vertex_indices\nend_header\n";
    const auto head = std::as_bytes(std::span(text));
    std::vector<std::byte> out(head.begin(), head.end());
    out.insert(out.end(), vertices_.begin(), vertices_.end());
    out.insert(out.end(), faces_.begin(), faces_.end());
    return out;
  }

 private:
  void add_vertex(const image::Vertex& vertex, Colour colour) {
    std::array<double, 3> point_m{};
    for (std::size_t i = 0; i < 3; ++i) {
      point_m[i] = header_.centre_m[i] + header_.radius_m * static_cast<double>(vertex.position[i]);
    }
    append(vertices_, std::as_bytes(std::span(point_m)));
    append(vertices_, std::as_bytes(std::span(colour)));
  }

  void add_hull(std::span<const image::Vertex> vertices) {
    std::vector<bake::PointF> points;
    for (const image::Vertex& v : vertices) {
      points.push_back({v.position[0], v.position[1], v.position[2]});
    }
    const bake::HullMesh hull = bake::convex_hull(points);
    for (const auto& face : hull.faces) {
      const std::array<std::uint32_t, 3> corners = {hull.vertices[face[0]], hull.vertices[face[1]],
                                                    hull.vertices[face[2]]};
      add_face(corners);
    }
  }

  void add_face(std::span<const std::uint32_t, 3> corners) {
    faces_.push_back(std::byte{3});
    for (const std::uint32_t c : corners) {
      const std::array<std::uint32_t, 1> index = {first_vertex_ + c};
      append(faces_, std::as_bytes(std::span(index)));
    }
    ++face_count_;
  }

  static void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
  }

  const image::Header& header_;
  std::vector<std::byte> vertices_;
  std::vector<std::byte> faces_;
  std::uint32_t first_vertex_ = 0;
  std::uint32_t face_count_ = 0;
};

}  // namespace

std::vector<std::byte> level_ply(const ImageView& image, std::uint32_t level) {
  PlyWriter writer(*image.header);
  for (std::uint32_t i = 0; i < image.pieces.size(); ++i) {
    if (is_alive(image, image.pieces[i], level)) writer.add_piece(image, i);
  }
  return writer.finish();
}

}  // namespace palpate::cli

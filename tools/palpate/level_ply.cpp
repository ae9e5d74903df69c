// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/level_ply.hpp"

#include <array>
#include <span>
#include <string>

#include "tools/palpate/level_mesh.hpp"
#include "tools/picture/colour.hpp"

namespace palpate::cli {
namespace {

void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

std::string ply_head(const LevelMesh& mesh) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " +
         std::to_string(mesh.points.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\n"
         "property uchar green\nproperty uchar blue\nelement face " +
         std::to_string(mesh.faces.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::array<double, 3> body_m(const image::Header& header, Vec3f point) {
  const Vec3d p = vec_cast<double>(point);
  return {header.centre_m[0] + header.radius_m * p.x, header.centre_m[1] + header.radius_m * p.y,
          header.centre_m[2] + header.radius_m * p.z};
}

}  // namespace

std::vector<std::byte> level_ply(const ImageView& image, std::uint32_t level) {
  const LevelMesh mesh = level_mesh(image, level);
  std::vector<std::byte> out;
  const std::string head = ply_head(mesh);
  append(out, std::as_bytes(std::span(head)));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const std::array<double, 3> point_m = body_m(*image.header, mesh.points[i]);
    const std::array colour = {picture::colour_of(mesh.piece_of_point[i])};
    append(out, std::as_bytes(std::span(point_m)));
    append(out, std::as_bytes(std::span(colour)));
  }
  for (const auto& face : mesh.faces) {
    out.push_back(std::byte{3});
    append(out, std::as_bytes(std::span(face)));
  }
  return out;
}

}  // namespace palpate::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>
#include <cstring>
#include <string>

#include "host_bake/mesh/read.hpp"

namespace palpate::bake {
namespace {

template <typename T>
void append(std::vector<std::byte>& out, const T& value) {
  static_assert(std::endian::native == std::endian::little, "the file is little-endian");
  const std::size_t at = out.size();
  out.resize(at + sizeof(T));
  std::memcpy(out.data() + at, &value, sizeof(T));
}

}  // namespace

std::vector<std::byte> to_ply(const Mesh& mesh) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment " + std::string(kWeldedComment) +
      "\nelement vertex " + std::to_string(mesh.points.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
      std::to_string(mesh.faces.size()) + "\nproperty list uchar uint vertex_indices\nend_header\n";
  std::vector<std::byte> out;
  out.reserve(header.size() + mesh.points.size() * sizeof(Point) +
              mesh.faces.size() * (1 + sizeof(Face)));
  for (const char c : header) out.push_back(static_cast<std::byte>(c));
  for (const Point& p : mesh.points) append(out, p);
  for (const Face& face : mesh.faces) {
    out.push_back(std::byte{3});
    append(out, face);
  }
  return out;
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
// Small meshes and mesh files for the tests.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "host_bake/mesh/read.hpp"

namespace palpate::bake::testing {

/// Cube of two triangles a side, outward.
Mesh cube(Point low = {0, 0, 0}, double size = 1);

/// Triangulated sphere, outward, 8 * 4^subdivisions faces.
Mesh sphere(Point centre = {0, 0, 0}, double radius = 1, int subdivisions = 2);

/// An open square of n x n cells in the plane z = 0, seen from +z.
Mesh sheet(std::uint32_t n);

/// The faces and vertices of both; nothing is shared.
Mesh together(const Mesh& a, const Mesh& b);

Mesh inside_out(Mesh mesh);

/// The file's bytes as a mesh file of that extension, through read_mesh().
ReadMesh read_as(std::string_view bytes, const std::string& extension, double unit_scale = 1);

/// What InputRefused says, or nothing where the bytes are accepted.
std::string refusal(std::string_view bytes, const std::string& extension);

template <typename T>
void append(std::string& out, T value, std::endian order = std::endian::little) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (order == std::endian::native) {
    out.append(raw, sizeof(T));
  } else {
    for (std::size_t i = sizeof(T); i-- > 0;) out += raw[i];
  }
}

// The mesh as a file of each format.
std::string to_obj(const Mesh& mesh);
std::string to_off(const Mesh& mesh);
std::string to_off_binary(const Mesh& mesh);
std::string to_stl_ascii(const Mesh& mesh);
std::string to_stl_binary(const Mesh& mesh, const std::string& header = "made by a test");
std::string to_ply_ascii(const Mesh& mesh);
std::string to_ply_binary(const Mesh& mesh, std::endian order, const std::string& newline = "\n");

}  // namespace palpate::bake::testing

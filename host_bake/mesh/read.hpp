// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files in and out.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

struct ReadMesh {
  Mesh mesh;                                  ///< polygons triangulated, vertices at equal positions welded, unreferenced ones dropped
  std::array<std::uint8_t, 32> sha256{};      ///< of the file's bytes
  std::size_t file_vertices = 0;              ///< as stored, before welding
  std::size_t file_faces = 0;
};

/// Reads OBJ, PLY, STL or OFF, ascii or binary, told apart by content (by extension where the content does not tell).
/// Coordinates are multiplied by unit_scale.
/// Throws InputRefused: unreadable, empty, cut, absurd counts, indices out of range, not finite, no triangles.
ReadMesh read_mesh(const std::filesystem::path& file, double unit_scale = 1.0);

/// Binary little-endian PLY, vertices as double, the same bytes for the same mesh.
std::vector<std::byte> to_ply(const Mesh& mesh);

}  // namespace palpate::bake

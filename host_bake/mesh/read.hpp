// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files in and out.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "host_bake/mesh/cracks.hpp"
#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

struct ReadMesh {
  Mesh mesh;  ///< polygons triangulated, vertices at equal positions and at rounding cracks welded,
              ///< unreferenced ones dropped
  Welded welded;                          ///< at rounding cracks
  std::array<std::uint8_t, 32> sha256{};  ///< of the file's bytes
  std::size_t file_vertices = 0;          ///< as stored, before welding
  std::size_t file_faces = 0;
};

/// The comment in the header of to_ply()'s files: vertices at equal positions are different
/// vertices.
inline constexpr std::string_view kWeldedComment = "palpate: vertices are welded";

/// Reads OBJ, PLY, STL or OFF, ascii or binary, told apart by content (by extension where the
/// content does not tell). Positions are welded where the file's numbers are equal, then multiplied
/// by unit_scale (finite, above zero), then welded at open edges where they differ by rounding, see
/// weld_coincident(). Vertices are in the order of their first use by a face. Nothing else is
/// repaired and no number guessed: a file is read whole or refused. A file of to_ply() is not
/// welded again, so that it comes back as it was written. Throws InputRefused: unreadable, empty,
/// cut, absurd counts, indices out of range, not finite, no triangles (or none after welding); with
/// file and line where the format has lines. Files up to 4 GiB. O(n log n) time.
ReadMesh read_mesh(const std::filesystem::path& file, double unit_scale = 1.0);

/// Binary little-endian PLY, vertices as double, the same bytes for the same mesh. read_mesh()
/// gives the same mesh back, but for the numbering of the vertices and those that no face uses.
std::vector<std::byte> to_ply(const Mesh& mesh);

}  // namespace palpate::bake

// SPDX-License-Identifier: Apache-2.0
// Typed, read-only access to a validated image, in place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/status.hpp"
#include "rt_core/image/format.hpp"
#include "rt_core/image/region_format.hpp"

namespace palpate {

/// Points into an image's bytes, which must outlive it. Only validate() makes a usable one. The
/// optional sections are empty where the image holds none.
struct ImageView {
  const image::Header* header = nullptr;
  std::span<const image::Level> levels;
  std::span<const image::Piece> pieces;
  std::span<const image::Vertex> vertices;
  std::span<const std::uint32_t> neighbour_starts;
  std::span<const std::uint32_t> neighbours;
  std::span<const image::Triangle> triangles;
  std::span<const image::VirtualFace> virtual_faces;
  std::span<const image::RegionNode> region_nodes;
  std::span<const image::RegionTriangle> region_triangles;
  std::span<const image::Region> regions;
  const image::ProximityGrid* proximity_grid = nullptr;  ///< null: the image holds none
  std::span<const std::uint32_t> proximity_bricks;
  std::span<const std::uint32_t> proximity_cells;
  std::span<const image::Vertex> culling_vertices;
  std::span<const image::SurfaceVertex> surface_vertices;
  std::span<const image::SurfaceNormal> vertex_normals;
  std::span<const std::uint32_t> surface_edges;
  std::span<const image::SurfaceRun> surface_runs;
  std::span<const image::TriangleVertices> triangle_vertices;
};

/// What Header::content_sha256 has to be: the hash of the image with those 32 bytes zero.
/// @param image  at least a header long
[[nodiscard]] std::array<std::uint8_t, 32> content_sha256(
    std::span<const std::byte> image) noexcept;

/// Proves that the bytes are a sound image and gives a view of it.
///
/// Checks, in this order: size, alignment, magic, byte order, version, total size, SHA-256, header
/// ranges, sections, levels, pieces, tree, indices, floats. Afterwards every index that the engine
/// follows is in range and every float finite, for hostile bytes too; docs/FORMAT.md lists the
/// invariants. Geometric truths (convexity, enclosure, true adjacency, every source triangle once)
/// are not proved here; `palpate inspect --verify` proves those.
///
/// A newer minor version loads: what this version does not know (reserved fields, flags, further
/// sections) is then ignored.
///
/// @param bytes     the whole image and nothing else; the first byte on a 64-byte boundary
/// @param out_view  written only where the result is Status::ok
/// Cost: one pass over the bytes for the hash, at most two over each section, and kMaxLevels steps
/// a piece; no memory, bounded stack. Not for the real-time loop.
Status validate(std::span<const std::byte> bytes, ImageView& out_view) noexcept;

}  // namespace palpate

// SPDX-License-Identifier: Apache-2.0
// Typed, read-only access to a validated image, in place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/status.hpp"
#include "rt_core/image/format.hpp"

namespace palpate {

/// Points into an image's bytes, which must outlive it. Only validate() makes a usable one.
struct ImageView {
  const image::Header* header = nullptr;
  std::span<const image::Level> levels;
  std::span<const image::Piece> pieces;
  std::span<const image::Vertex> vertices;
  std::span<const std::uint32_t> neighbour_starts;
  std::span<const std::uint32_t> neighbours;
  std::span<const image::Triangle> triangles;
  std::span<const image::VirtualFace> virtual_faces;
};

/// Proves that the bytes are a sound image and gives a view of it.
///
/// Checks, in this order: size, alignment, magic, byte order, version, total size, SHA-256, header ranges, sections, levels,
/// pieces, tree, indices, floats. Afterwards every index that the engine follows is in range and every float finite, for
/// hostile bytes too. Geometric truths (convexity, enclosure) are not proved here; `palpate inspect --verify` proves those.
///
/// @param bytes     the whole image and nothing else; the first byte on a 64-byte boundary
/// @param out_view  written only where the result is Status::ok
/// Cost: one pass over the bytes for the hash and one over each section; no memory, bounded stack. Not for the real-time loop.
Status validate(std::span<const std::byte> bytes, ImageView& out_view) noexcept;

}  // namespace palpate

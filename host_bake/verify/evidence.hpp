// SPDX-License-Identifier: GPL-3.0-or-later
// What the proofs of verify() share: an image, and its hulls computed anew from their vertices.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host_bake/bake.hpp"
#include "host_bake/hull/hull.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::bake {

struct Evidence {
  ImageView image;
  std::vector<std::vector<PointF>> points;  ///< [pieces] each run's positions, hull vertices first
  std::vector<HullMesh> hulls;  ///< [pieces] of the hull vertices; indices local to the run
};

/// Recomputes all hulls, in parallel. O(n log n).
Evidence gather(const ImageView& image);

/// The hull vertices' positions of a piece.
std::span<const PointF> hull_points(const Evidence& evidence, std::uint32_t piece);

/// The triangles of a piece's patch.
std::span<const image::Triangle> patch(const Evidence& evidence, const image::Piece& piece);

/// The pieces that belong to a level, ascending.
std::vector<std::uint32_t> alive_at(const ImageView& image, std::uint32_t level);

/// The answer where a proof needs the original surface and the image is without it.
Proof not_provable(const std::string& invariant);

/// What a proof goes through one by one.
struct Things {
  std::size_t count = 0;
  std::string one = "piece";
  std::string many = "pieces";
};

/// Runs a check on each, in parallel. A check returns an empty string, or what is wrong, always the
/// same. The proof's `found` is the number of those checked, or the first that fails and why.
Proof prove_each(const std::string& invariant, const Things& things,
                 const std::function<std::string(std::uint32_t)>& check);

/// The same of pieces.
Proof prove_each(const std::string& invariant, std::size_t pieces,
                 const std::function<std::string(std::uint32_t)>& check);

}  // namespace palpate::bake

// SPDX-License-Identifier: Apache-2.0
// The passes of validate(), in the order in which it makes them. Private to this folder.
//
// Each pass may trust what the ones before it have proved. All are O(bytes) with a bounded stack.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/status.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::image::checks {

/// True for finite values in [low, high]; false for NaN.
template <class T>
constexpr bool within(T value, T low, T high) noexcept {
  return value >= low && value <= high;
}

inline double squared_length(const float (&v)[3]) noexcept {
  double sum = 0;
  for (const float x : v) sum += static_cast<double>(x) * static_cast<double>(x);
  return sum;
}
/// Within what rounding to float leaves.
inline bool is_unit(const float (&v)[3]) noexcept {
  return within(squared_length(v), 1 - 1e-6, 1 + 1e-6);
}
inline bool is_unit_or_zero(const float (&v)[3]) noexcept {
  return is_unit(v) || squared_length(v) == 0;
}

/// Ranges and consistency of the header's own fields. image_bad_header.
Status check_header(const Header& header) noexcept;

/// Slots, strides, order, bounds and zero padding. `bytes` has header.total_bytes bytes.
/// image_bad_section, image_missing_section.
Status check_sections(const Header& header, std::span<const std::byte> bytes) noexcept;

/// The level records alone. image_bad_level, image_bad_float, image_over_limit.
Status check_levels(const ImageView& image) noexcept;

/// Each piece's record: its numbers, its flags, and its runs, which tile their sections.
/// image_bad_piece, image_bad_float, image_over_limit.
Status check_pieces(const ImageView& image) noexcept;

/// Parent and child links form one tree whose levels fall from parent to child. image_bad_tree,
/// image_over_limit.
Status check_tree(const ImageView& image) noexcept;

/// Vertex indices of triangles, virtual faces and neighbour lists. image_bad_index.
Status check_indices(const ImageView& image) noexcept;

/// Positions, support areas and spheres. image_bad_float, image_bad_piece (a vertex outside).
Status check_vertices(const ImageView& image) noexcept;

/// What the level records say of their pieces. image_bad_level.
Status check_level_totals(const ImageView& image) noexcept;

/// The capacities in the header are the true ones. image_bad_header.
Status check_capacities(const ImageView& image) noexcept;

/// The region engine's sections: all or none; one tree whose boxes hold its triangles; regions and
/// triangles refer to it and to one another. image_missing_section, image_over_limit,
/// image_bad_section, image_bad_tree, image_bad_index, image_bad_float.
Status check_regions(const ImageView& image) noexcept;

/// What tells where to look first: all four sections or none, and what they name exists.
/// image_missing_section, image_bad_section, image_bad_float, image_bad_index.
Status check_proximity(const ImageView& image) noexcept;

/// What contacts see of the surface: all sections or none; runs tile, indices exist, corners agree
/// with the triangles', normals are unit. image_missing_section, image_bad_section,
/// image_bad_index, image_bad_float.
Status check_surface(const ImageView& image) noexcept;

}  // namespace palpate::image::checks

// SPDX-License-Identifier: GPL-3.0-or-later
// What the readers of the single formats hand over: polygons exactly as the file has them.
//
// CGAL 5.5's own readers are not used. They allocate what a file counts before they read it (a PLY
// list of 5e8 indices in a file of 200 bytes takes 2 GB), dereference null for integer coordinates
// in a PLY when assertions are off, cut faces short without a word (an OBJ with tabs), and refuse
// legal files (OBJ with lines, PLY with 8- or 16-bit indices, STL in upper case).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

struct Soup {
  std::vector<Point> points;                ///< as stored, finite or not
  std::vector<std::uint32_t> corners;       ///< indices into points, polygon after polygon
  std::vector<std::uint32_t> polygon_ends;  ///< of each polygon: one past its last corner

  /// Ends the polygon made of the corners pushed since the last one. Precondition: three or more.
  void end_polygon() { polygon_ends.push_back(static_cast<std::uint32_t>(corners.size())); }
};

/// Files beyond this are refused; below it every count of a file fits into 32 bits.
inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 32;

/// Each reads the whole file's bytes. `file` is named in errors. Throws InputRefused for anything
/// that is not a complete file of the format with all indices in range. Time and memory are
/// O(bytes) whatever the counts in the file say.
Soup read_obj(std::string_view bytes, const std::string& file);
Soup read_off(std::string_view bytes,
              const std::string& file);  ///< with C, N, ST prefixes, ascii or binary
Soup read_ply(std::string_view bytes,
              const std::string& file);  ///< ascii, binary of either byte order; faces or strips
Soup read_stl_ascii(std::string_view bytes, const std::string& file);
Soup read_stl_binary(std::string_view bytes, const std::string& file);

/// Is this the size of a binary STL with the count that its header gives?
bool is_binary_stl(std::string_view bytes);

/// The first word of an OFF file, with its prefixes?
bool is_off_keyword(std::string_view word);

}  // namespace palpate::bake

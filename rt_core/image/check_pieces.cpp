// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "rt_core/image/checks.hpp"

namespace palpate::image::checks {
namespace {

constexpr std::uint32_t kKnownFlags = static_cast<std::uint32_t>(PieceFlag::all_real) |
                                      static_cast<std::uint32_t>(PieceFlag::back_open);

bool flag(const Piece& piece, PieceFlag f) noexcept {
  return (piece.flags & static_cast<std::uint32_t>(f)) != 0;
}

// Rounding of a mean of unit vectors.
constexpr double kMaxSquaredMean = 1 + 1e-6;

// Where the next piece's runs have to start. 64 bits, so that hostile counts cannot wrap.
struct Cursor {
  std::uint64_t vertices = 0;
  std::uint64_t neighbour_starts = 0;
  std::uint64_t neighbours = 0;
  std::uint64_t triangles = 0;
  std::uint64_t virtual_faces = 0;
  std::uint64_t culling_vertices = 0;
};

// An optional run starts at the cursor where it has records and nowhere where it has none.
bool take(std::uint32_t first, std::uint64_t count, std::size_t section_count,
          std::uint64_t& cursor) noexcept {
  if (count == 0) return first == kNone;
  if (first != cursor || count > section_count - cursor) return false;
  cursor += count;
  return true;
}

bool take_adjacency(const ImageView& image, const Piece& piece, Cursor& cursor) noexcept {
  const bool has_lists = piece.hull_vertices > kAdjacencyAbove;
  const std::uint64_t starts = has_lists ? std::uint64_t{piece.hull_vertices} + 1 : 0;
  if (!take(piece.first_neighbour_start, starts, image.neighbour_starts.size(),
            cursor.neighbour_starts)) {
    return false;
  }
  const std::uint64_t length =
      has_lists ? image.neighbour_starts[piece.first_neighbour_start + piece.hull_vertices] : 0;
  return (length > 0) == has_lists &&
         take(piece.first_neighbour, length, image.neighbours.size(), cursor.neighbours);
}

bool take_runs(const ImageView& image, const Piece& piece, Cursor& cursor) noexcept {
  return piece.culling_vertices <= kMaxCullingVertices && piece.hull_vertices >= 1 &&
         piece.hull_vertices <= piece.vertices &&
         take(piece.first_vertex, piece.vertices, image.vertices.size(), cursor.vertices) &&
         take_adjacency(image, piece, cursor) &&
         take(piece.first_triangle, piece.triangles, image.triangles.size(), cursor.triangles) &&
         take(piece.first_virtual_face, piece.virtual_faces, image.virtual_faces.size(),
              cursor.virtual_faces) &&
         take(piece.first_culling_vertex, piece.culling_vertices, image.culling_vertices.size(),
              cursor.culling_vertices);
}

bool all_taken(const ImageView& image, const Cursor& cursor) noexcept {
  return cursor.vertices == image.vertices.size() &&
         cursor.neighbour_starts == image.neighbour_starts.size() &&
         cursor.neighbours == image.neighbours.size() &&
         cursor.triangles == image.triangles.size() &&
         cursor.virtual_faces == image.virtual_faces.size() &&
         cursor.culling_vertices == image.culling_vertices.size();
}

// A free level's pieces have no patch; a patch without virtual faces is all real.
bool patch_sound(const Piece& piece, bool is_free) noexcept {
  if ((piece.triangles == 0) != is_free) return false;
  if (is_free) return piece.virtual_faces == 0 && !flag(piece, PieceFlag::all_real);
  if (flag(piece, PieceFlag::all_real) != (piece.virtual_faces == 0)) return false;
  return !flag(piece, PieceFlag::back_open) || piece.triangles <= kMaxOpenPatchTriangles;
}

bool words_sound(const Piece& piece, bool is_newer) noexcept {
  if (is_newer) return true;
  std::uint32_t bits = piece.flags & ~kKnownFlags;
  for (const std::uint32_t r : piece.reserved) bits |= r;
  return bits == 0;
}

// The patch of an open surface has no side.
bool normal_sound(const Piece& piece) noexcept {
  double squared_norm = 0;
  for (const float c : piece.patch_normal) {
    if (!within(c, -1.0f, 1.0f)) return false;
    squared_norm += static_cast<double>(c) * static_cast<double>(c);
  }
  if (squared_norm == 0) return piece.patch_cosine == 0;
  return piece.triangles > 0 && !flag(piece, PieceFlag::back_open) &&
         squared_norm <= kMaxSquaredMean && within(piece.patch_cosine, -1.0f, 1.0f);
}

bool culling_sound(const Piece& piece) noexcept {
  return piece.culling_vertices == 0 ? piece.culling_residual == piece.hausdorff
                                     : within(piece.culling_residual, 0.0f, kMaxLength);
}

bool numbers_sound(const Piece& piece, float level_resolution) noexcept {
  double squared_norm = 0;
  for (const float c : piece.centre) {
    if (!within(c, -kMaxNorm, kMaxNorm)) return false;
    squared_norm += static_cast<double>(c) * static_cast<double>(c);
  }
  return squared_norm <= static_cast<double>(kMaxNorm) * static_cast<double>(kMaxNorm) &&
         within(piece.radius, 0.0f, kMaxLength) &&
         within(piece.surface_deviation, 0.0f, kMaxLength) &&
         within(piece.hausdorff, 0.0f, kMaxLength) && culling_sound(piece) &&
         piece.resolution == level_resolution && within(piece.min_support_area, kMinArea, kMaxArea);
}

}  // namespace

Status check_levels(const ImageView& image) noexcept {
  const std::size_t count = image.levels.size();
  if (count > kMaxLevels) return Status::image_over_limit;
  const std::uint32_t free_levels = image.header->free_levels;
  if (free_levels >= count) return Status::image_bad_level;  // level 0 is the original surface
  const bool is_newer = image.header->format_minor > kFormatMinor;
  for (std::size_t i = 0; i < count; ++i) {
    const Level& level = image.levels[i];
    const bool is_free = i >= count - free_levels;
    if (level.free != (is_free ? 1u : 0u) || (level.triangles == 0) != is_free ||
        (level.reserved != 0 && !is_newer)) {
      return Status::image_bad_level;
    }
    const float most = is_free ? 0.0f : std::numeric_limits<float>::max();
    if (!within(level.resolution, 0.0f, most)) return Status::image_bad_float;
  }
  return Status::ok;
}

Status check_pieces(const ImageView& image) noexcept {
  if (image.pieces.size() > kMaxPieces) return Status::image_over_limit;
  const bool is_newer = image.header->format_minor > kFormatMinor;
  Cursor cursor;
  for (const Piece& piece : image.pieces) {
    if (piece.hull_vertices > kMaxHullVertices) return Status::image_over_limit;
    if (piece.level >= image.levels.size()) return Status::image_bad_piece;
    const Level& level = image.levels[piece.level];
    if (!words_sound(piece, is_newer) || !patch_sound(piece, level.free != 0) ||
        !take_runs(image, piece, cursor)) {
      return Status::image_bad_piece;
    }
    if (!numbers_sound(piece, level.resolution) || !normal_sound(piece)) {
      return Status::image_bad_float;
    }
  }
  return all_taken(image, cursor) ? Status::ok : Status::image_bad_piece;
}

}  // namespace palpate::image::checks

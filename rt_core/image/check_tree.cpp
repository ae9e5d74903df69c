// SPDX-License-Identifier: Apache-2.0
#include "rt_core/image/checks.hpp"

namespace palpate::image::checks {
namespace {

bool children_sound(const ImageView& image, std::uint32_t parent) noexcept {
  const Piece& piece = image.pieces[parent];
  if ((piece.children == 0) != (piece.level == 0)) return false;
  if (piece.children == 0) return piece.first_child == kNone;
  const std::size_t count = image.pieces.size();
  if (piece.first_child <= parent || piece.first_child >= count ||
      piece.children > count - piece.first_child) {
    return false;
  }
  for (std::uint32_t i = 0; i < piece.children; ++i) {
    const Piece& child = image.pieces[piece.first_child + i];
    if (child.parent != parent || child.level >= piece.level) return false;
  }
  return true;
}

// The first level to which the piece no longer belongs.
std::uint32_t end_level(const ImageView& image, const Piece& piece) noexcept {
  return piece.parent == kNone ? static_cast<std::uint32_t>(image.levels.size())
                               : image.pieces[piece.parent].level;
}

// Levels rise on the way up, so the walk ends within kMaxLevels steps.
std::uint32_t depth_of(const ImageView& image, std::uint32_t index) noexcept {
  std::uint32_t depth = 1;
  for (; image.pieces[index].parent != kNone && depth <= kMaxLevels; ++depth) {
    index = image.pieces[index].parent;
  }
  return depth;
}

template <class T>
void raise(T& most, T value) noexcept {
  if (value > most) most = value;
}

struct LevelTotals {
  std::uint64_t triangles = 0;
  std::uint32_t pieces = 0;
  float surface_deviation = 0;
  float hausdorff = 0;
  float min_support_area = kMaxArea;
};

void add(LevelTotals& totals, const Piece& piece) noexcept {
  totals.triangles += piece.triangles;
  ++totals.pieces;
  raise(totals.surface_deviation, piece.surface_deviation);
  raise(totals.hausdorff, piece.hausdorff);
  if (piece.min_support_area < totals.min_support_area) {
    totals.min_support_area = piece.min_support_area;
  }
}

bool matches(const Level& level, const LevelTotals& totals) noexcept {
  return level.pieces == totals.pieces &&
         level.triangles == (level.free != 0 ? 0 : totals.triangles) &&
         level.max_surface_deviation_rel == totals.surface_deviation &&
         level.max_hausdorff_rel == totals.hausdorff &&
         level.min_support_area_rel == totals.min_support_area;
}

// Longest of the piece's lists; 0 where it has none.
std::uint32_t valence(const ImageView& image, const Piece& piece) noexcept {
  std::uint32_t most = 0;
  if (piece.first_neighbour_start == kNone) return most;
  for (std::uint32_t v = 0; v < piece.hull_vertices; ++v) {
    const std::uint32_t* starts = &image.neighbour_starts[piece.first_neighbour_start + v];
    raise(most, starts[1] - starts[0]);
  }
  return most;
}

}  // namespace

// Every piece names one parent, and every run of children names pieces that name its owner; so no
// piece is in two runs, and where the runs add up to all pieces but the root, all are in one.
// Children come after their parent, so there is no cycle.
Status check_tree(const ImageView& image) noexcept {
  const Piece& root = image.pieces[0];
  if (root.parent != kNone || root.level + 1 != image.levels.size()) return Status::image_bad_tree;
  std::uint64_t children = 0;
  for (std::uint32_t i = 0; i < image.pieces.size(); ++i) {
    if (image.pieces[i].children > kMaxChildren) return Status::image_over_limit;
    if (!children_sound(image, i)) return Status::image_bad_tree;
    children += image.pieces[i].children;
  }
  return children == image.pieces.size() - 1 ? Status::ok : Status::image_bad_tree;
}

Status check_level_totals(const ImageView& image) noexcept {
  LevelTotals totals[kMaxLevels];
  for (const Piece& piece : image.pieces) {
    const std::uint32_t end = end_level(image, piece);
    for (std::uint32_t level = piece.level; level < end; ++level) add(totals[level], piece);
  }
  for (std::size_t i = 0; i < image.levels.size(); ++i) {
    if (!matches(image.levels[i], totals[i])) return Status::image_bad_level;
  }
  const Header& header = *image.header;
  const bool original = header.dropped_levels == 0;
  return !original || image.levels[0].triangles == header.source_triangles
             ? Status::ok
             : Status::image_bad_level;
}

Status check_capacities(const ImageView& image) noexcept {
  std::uint32_t tree_depth = 0;
  std::uint32_t max_children = 0;
  std::uint32_t max_hull_vertices = 0;
  std::uint32_t max_patch_triangles = 0;
  std::uint32_t max_valence = 0;
  std::uint32_t leaf_pieces = 0;
  for (std::uint32_t i = 0; i < image.pieces.size(); ++i) {
    const Piece& piece = image.pieces[i];
    if (piece.children == 0) {
      ++leaf_pieces;
      raise(tree_depth, depth_of(image, i));
    }
    raise(max_children, piece.children);
    raise(max_hull_vertices, piece.hull_vertices);
    raise(max_patch_triangles, piece.triangles);
    raise(max_valence, valence(image, piece));
  }
  const Header& header = *image.header;
  const bool agrees = header.tree_depth == tree_depth && header.max_children == max_children &&
                      header.max_hull_vertices == max_hull_vertices &&
                      header.max_patch_triangles == max_patch_triangles &&
                      header.max_valence == max_valence && header.leaf_pieces == leaf_pieces;
  return agrees ? Status::ok : Status::image_bad_header;
}

}  // namespace palpate::image::checks

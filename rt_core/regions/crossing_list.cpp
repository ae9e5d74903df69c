// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/crossing_list.hpp"

namespace palpate::regions {

void note_crossing(const levels::PairState& pair, std::uint32_t triangle_a,
                   std::uint32_t triangle_b, CrossingList& list) noexcept {
  add_segment(pair, triangle_a, triangle_b, list.curve);
  const std::uint32_t a = pair.image_a->region_triangles[triangle_a].piece;
  const std::uint32_t b = pair.image_b->region_triangles[triangle_b].piece;
  for (std::uint32_t i = 0; i < list.count; ++i) {
    if (list.piece_a[i] == a && list.piece_b[i] == b) return;
  }
  if (list.count == kMaxCrossings) return;
  list.piece_a[list.count] = a;
  list.piece_b[list.count++] = b;
}

}  // namespace palpate::regions

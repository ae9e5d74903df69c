// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/crossing_list.hpp"

namespace palpate::regions {
namespace {

CrossingCurve& curve_of(std::uint32_t a, std::uint32_t b, CrossingList& list) noexcept {
  for (std::uint32_t i = 0; i < list.count; ++i) {
    if (list.pieces[i].a == a && list.pieces[i].b == b) return list.pieces[i].curve;
  }
  if (list.count == kMaxCrossings) return list.rest;
  CrossingPieces& added = list.pieces[list.count++];
  added = {a, b, {}};
  return added.curve;
}

}  // namespace

void note_crossing(const levels::PairState& pair, std::uint32_t triangle_a,
                   std::uint32_t triangle_b, CrossingList& list) noexcept {
  add_segment(pair, triangle_a, triangle_b,
              curve_of(pair.image_a->region_triangles[triangle_a].piece,
                       pair.image_b->region_triangles[triangle_b].piece, list));
}

}  // namespace palpate::regions

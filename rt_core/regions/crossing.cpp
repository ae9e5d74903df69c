// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/crossing.hpp"

namespace palpate::regions {
namespace {

Crossing crossing_of(const levels::PairState& pair, std::uint32_t piece_a, std::uint32_t piece_b,
                     convex::PenetrationScratch& scratch) noexcept {
  Crossing out;
  out.piece_a = piece_a;
  out.piece_b = piece_b;
  const convex::Hull a =
      levels::hull_of(*pair.image_a, pair.image_a->pieces[piece_a], pair.scale_a);
  const convex::Hull b =
      levels::hull_of(*pair.image_b, pair.image_b->pieces[piece_b], pair.scale_b);
  convex::Cache cache;
  const convex::Distance apart = convex::distance(a, b, pair.b_in_a, {.above = 0}, cache);
  if (apart.state == convex::State::separated) {  // by rounding: they touch
    out.depth = 0;
    out.point_a = apart.point_a;
    out.point_b = apart.point_b;
    out.normal = apart.normal;
    return out;
  }
  const convex::Penetration p = convex::penetration(a, b, pair.b_in_a, cache, scratch);
  out.depth = p.depth;
  out.point_a = p.point_a;
  out.point_b = p.point_b;
  out.normal = p.normal;
  out.exact = p.exact;
  return out;
}

}  // namespace

Crossing deepest(const levels::PairState& pair, CrossingScratch& scratch) noexcept {
  Crossing best;
  for (std::uint32_t i = 0; i < scratch.list.count; ++i) {
    const Crossing next =
        crossing_of(pair, scratch.list.piece_a[i], scratch.list.piece_b[i], scratch.polytope);
    if (next.depth > best.depth) best = next;
  }
  return best;
}

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/crossing.hpp"

namespace palpate::regions {

Crossing crossing_of(const levels::PairState& pair, std::uint32_t triangle_a,
                     std::uint32_t triangle_b, CrossingScratch& scratch) noexcept {
  Crossing out;
  out.piece_a = pair.image_a->region_triangles[triangle_a].piece;
  out.piece_b = pair.image_b->region_triangles[triangle_b].piece;
  const convex::Hull a =
      levels::hull_of(*pair.image_a, pair.image_a->pieces[out.piece_a], pair.scale_a);
  const convex::Hull b =
      levels::hull_of(*pair.image_b, pair.image_b->pieces[out.piece_b], pair.scale_b);
  convex::Cache cache;
  const convex::Distance apart = convex::distance(a, b, pair.b_in_a, 0, cache);
  if (apart.state == convex::State::separated) {  // rounding: they touch
    out.point_a = apart.point_a;
    out.point_b = apart.point_b;
    out.normal = apart.normal;
    return out;
  }
  const convex::Penetration p = convex::penetration(a, b, pair.b_in_a, cache, scratch.polytope);
  out.depth = p.depth;
  out.point_a = p.point_a;
  out.point_b = p.point_b;
  out.normal = p.normal;
  out.exact = p.exact;
  return out;
}

}  // namespace palpate::regions

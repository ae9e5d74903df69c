// SPDX-License-Identifier: GPL-3.0-or-later
// The constraints on merges.
#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "host_bake/simplify/constraints.hpp"

namespace palpate::bake {

/// Each of two patches is below its own planes; is it below the other's? Tells first for the faces
/// of the smaller one.
bool Constraints::below_each_other(std::uint32_t large, std::uint32_t small) {
  const std::array<std::uint32_t, 2> both = {large, small};
  gatherer_.gather(patches_, both, nullptr, merged_.shape);
  const PatchShape& shape = merged_.shape;
  const std::uint32_t faces = patches_.size(large);
  std::uint32_t& first = merged_first_;
  first = 0;
  for (std::uint32_t f = 0; f < faces; ++f)
    for (const std::uint32_t v : shape.corners[f]) first = std::max(first, v + 1);
  merged_.planes.set(shape);
  const auto all = static_cast<std::uint32_t>(shape.points.size());
  for (auto f = faces; f < shape.faces.size(); ++f)
    if (merged_.planes.any_above(shape, f, 0, first)) return false;
  for (std::uint32_t f = 0; f < faces; ++f)
    if (merged_.planes.any_above(shape, f, first, all)) return false;
  return true;
}

/// The body of the larger patch, known or built for this, grows by the points of the smaller one,
/// and nothing is where it does so. False decides nothing.
bool Constraints::merges_within(std::uint32_t large, std::uint32_t small) {
  OuterHull* outer = bodies_.growing(large);
  if (outer == nullptr) return false;
  outer->take_back();
  const auto foreign = [&](std::uint32_t f) {
    return patches_.of(f) != large && patches_.of(f) != small;
  };
  const std::span<const PointF> added = std::span(merged_.shape.points).subspan(merged_first_);
  for (const PointF& p : added) {
    const bool guests_stay_out =
        std::all_of(outer->guests().begin(), outer->guests().end(),
                    [&](const OuterHull::Guest& guest) { return guest.stays_out(p); });
    if (!guests_stay_out || !outer->has_room()) return false;
    OuterHull::Part* part = outer->grow(p, builder_);
    if (part != nullptr && faces_.search(part->grown, [&](std::uint32_t f) {
          return foreign(f) && enters(part->hull, corners(f));
        }))
      return false;
  }
  return true;
}

bool Constraints::may_merge(std::uint32_t a, std::uint32_t b) {
  if (patches_.size(a) < patches_.size(b)) std::swap(a, b);
  if (!below_each_other(a, b)) return false;
  const PatchShape& shape = merged_.shape;
  merged_.within = PatchBodies::is_large(patches_.size(a)) && merges_within(a, b);
  if (merged_.within) return true;
  if (OuterHull* outer = bodies_.known_growing(a)) outer->take_back();
  FaceBox all;
  merged_.kind = builder_.build(shape, nullptr, gatherer_, merged_.hull, all);
  if (merged_.kind == HullKind::refused) return false;
  if (merged_.kind == HullKind::empty) return true;
  return !faces_.search(all, [&](std::uint32_t f) {
    return patches_.of(f) != a && patches_.of(f) != b && enters(merged_.hull, corners(f));
  });
}

void Constraints::follow_merge(std::uint32_t kept, std::uint32_t gone) {
  boxes_.take(gone);
  place(kept, box_of(merged_.shape.points));
  bodies_.forget(gone);
  if (merged_.within) {
    bodies_.keep(kept);
  } else {
    bodies_.set(kept, merged_.kind, merged_.shape.faces.size(), merged_.hull);
  }
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/outer_hull.hpp"

#include <algorithm>
#include <utility>

#include "host_bake/decompose/geometry.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kFewParts = 16;         // that are always worth keeping
constexpr std::size_t kFacesForEachPart = 8;  // a new hull costs some microseconds for each

}  // namespace

bool OuterHull::Guest::stays_out(const PointF& p) const {
  const Vec3d at = position(p);
  return std::all_of(keepers.begin(), keepers.end(),
                     [at](const BoundingPlane& plane) { return plane.holds(at); });
}

HullKind OuterHull::build(const PatchShape& shape, ShapeGatherer& gatherer, ShrunkHull& out_hull) {
  FaceBox all;
  const HullKind kind = builder_.build(shape, nullptr, gatherer, out_hull, all);
  Vec3d sum{};
  for (const PointF& p : shape.points) sum += position(p);
  const Vec3f mean = vec_cast<float>((1 / static_cast<double>(shape.points.size())) * sum);
  inner_ = {mean.x, mean.y, mean.z};
  most_parts_ = kFewParts + shape.faces.size() / kFacesForEachPart;
  return kind;
}

bool OuterHull::full() const {
  return !builder_.has_room() || parts_.size() + guests_.size() >= most_parts_;
}

OuterHull::Part* OuterHull::grow(const PointF& p, HullBuilder& scratch) {
  points_.clear();
  if (!builder_.add(p, points_)) return nullptr;
  Part& part = parts_.emplace_back();
  part.grown = with_margin(palpate::bake::box_of(points_));
  points_.push_back(inner_);
  scratch.build(points_, part.hull);
  return &part;
}

void OuterHull::keep() {
  builder_.keep();
  kept_ = parts_.size();
  for (Guest& guest : admitted_) {
    const auto same = [&](const Guest& other) { return other.face == guest.face; };
    if (const auto known = std::find_if(guests_.begin(), guests_.end(), same);
        known != guests_.end()) {
      *known = std::move(guest);
    } else {
      guests_.push_back(std::move(guest));
    }
  }
  admitted_.clear();
}

void OuterHull::admit(std::uint32_t face, std::vector<BoundingPlane> keepers) {
  admitted_.push_back({face, std::move(keepers)});
}

void OuterHull::take_back() {
  admitted_.clear();
  if (parts_.size() == kept_) return;
  builder_.take_back();
  parts_.resize(kept_);
}

bool OuterHull::parts_entered_by(const std::array<PointF, 3>& triangle) {
  const FaceBox box = palpate::bake::box_of(triangle[0], triangle[1], triangle[2]);
  return std::any_of(parts_.begin(), parts_.end(), [&](Part& part) {
    return !part.hull.surely_outside(box) &&
           part.hull.entered_by(position(triangle[0]), position(triangle[1]),
                                position(triangle[2]));
  });
}

}  // namespace palpate::bake

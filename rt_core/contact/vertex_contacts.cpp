// SPDX-License-Identifier: Apache-2.0
#include "rt_core/contact/facing.hpp"
#include "rt_core/contact/found.hpp"

namespace palpate::contact {
namespace {

/// Equal directions and distances.
constexpr double kSame = 1e-12;
/// Closer points than this have no direction between them.
constexpr double kTouching = 1e-12;
/// What a way that does not count is short of zero, as a share of one that does: "at least zero" is
/// a constraint too, of ways between 90 and 180 degrees from others.
constexpr double kFadedWay = 0.13;
/// Ways that cancel each other to this share of the strongest do not count.
constexpr double kCancelling = 4;

/// Distances to the side of a concave edge, in the larger of delta and the distance from the face,
/// up to which the face counts wholly, and from which it does not.
constexpr double kBesideWhole = 0.5;
constexpr double kBesideNone = 1;

bool same(double a, double b) noexcept { return (a < b ? b - a : a - b) < kSame; }

class VertexContacts {
 public:
  VertexContacts(const Side& side, Pace& pace, std::uint32_t vertex, double delta,
                 Scratch& scratch) noexcept
      : side_(side),
        pace_(pace),
        vertex_(vertex),
        delta_(delta),
        reach_(kReach * delta),
        scratch_(scratch),
        x_(side.to_target(position(side.points, vertex))) {}

  SignedDistance run(std::uint32_t hint) noexcept {
    SignedDistance at;
    if (!collect(hint, at)) {
      at = signed_distance(side_.target, pace_, x_, hint, kAnywhere);
      feet_ = 0;
    }
    if (at.foot.triangle == image::kNone || at.value > reach_) return at;
    inside_ = at.value < 0;
    depth_ = inside_ ? -at.value : 0;
    solidity_ = solidity(side_.target.surface, depth_);
    const double radius = radius_of(depth_);
    const double radius2 = radius * radius;
    if (feet_ > 0) {
      for (std::uint32_t i = 0; i < feet_; ++i) {
        if (scratch_.feet[i].squared <= radius2) see(scratch_.feet[i]);
      }
    } else {
      for_each_near(side_.target, pace_, x_, radius, [&](std::uint32_t triangle) {
        const Foot foot = closest_point(side_.target.surface, triangle, x_);
        if (foot.squared <= radius2) see(foot);
      });
    }
    if (ways_ > 0) leave();
    return at;
  }

 private:
  /// How far triangles may be that tell of contacts.
  double radius_of(double depth) const noexcept {
    const double radius = reach_ / kLeastTiltCosine;
    return (kMostDetour * depth > radius ? kMostDetour * depth : radius) * kRoomForRounding;
  }

  /// With a hint that is near, all triangles that tell of contacts are met at once.
  /// @return false where that is not known, or they are too many
  bool collect(std::uint32_t hint, SignedDistance& at) noexcept {
    if (hint == image::kNone) return false;
    const double near = sqrt_of(closest_point(side_.target.surface, hint, x_).squared);
    if (near > reach_) return false;
    const double radius = radius_of(near);
    const double radius2 = radius * radius;
    for_each_near(side_.target, pace_, x_, radius, [&](std::uint32_t triangle) {
      const Foot foot = closest_point(side_.target.surface, triangle, x_);
      if (foot.squared > radius2) return;
      if (feet_ < kMostFeet) scratch_.feet[feet_] = foot;
      ++feet_;
      if (at.is_nearer(foot) && squared_norm(face_normal(side_.target.surface, triangle)) > 0) {
        at.foot = foot;
      }
    });
    if (feet_ > kMostFeet || at.foot.triangle == image::kNone) return false;
    at.value = signed_by(side_.target.surface, at.foot, x_);
    return true;
  }

  void see(const Foot& foot) noexcept {
    const Surface& target = side_.target.surface;
    const Vec3d face = face_normal(target, foot.triangle);
    if (squared_norm(face) == 0) return;
    const Vec3d apart = x_ - foot.point;
    const double distance = sqrt_of(foot.squared);
    const bool touching = distance < kTouching;
    const bool behind = touching ? inside_ : dot(apart, pseudonormal(target, foot)) < 0;
    const Vec3d direction = touching ? face : (behind ? -1 / distance : 1 / distance) * apart;
    const NearestNormal nearest =
        touching ? NearestNormal{face, 1} : nearest_at(target, foot, direction);
    const double agrees = facing(nearest.cosine);
    const double ahead = dot(nearest.normal, apart);
    if (!behind) {
      if (agrees > 0 && ahead <= reach_) add(nearest.normal, ahead, agrees, foot);
    } else if (inside_ && agrees > 0) {
      add_way(nearest.normal, ahead < 0 ? -ahead : 0, agrees, foot);
    }
    if (inside_ && foot.feature != Feature::face) add_beside(foot, apart, distance);
  }

  /// Cosine between a push of the vertex and what its faces face.
  double faces(Vec3d normal) const noexcept {
    return nearest_at_vertex(side_.points, vertex_, side_.turned_to_points(-normal)).cosine;
  }

  void add(Vec3d normal, double distance, double weight, const Foot& foot) noexcept {
    if (!(weight > 0) || distance > reach_) return;
    const double near = weight * within_reach(distance, delta_);
    const double w = near > 0 ? near * facing(faces(normal)) : 0;
    if (w > 0) scratch_.found.add({normal, distance, w, x_, foot.point, foot.triangle});
  }

  void add_way(Vec3d normal, double length, double agrees, const Foot& foot) noexcept {
    const double direct = directness(depth_, length);
    if (direct == 0 && length / agrees >= shortest_) return;
    const double willing = clamp01(1 + 2 * faces(normal));
    const WayOut way{normal,           foot.point,   length, direct * agrees * willing,
                     agrees * willing, foot.triangle};
    if (!(way.facing > 0)) return;
    const double weighted = length / way.facing;
    shortest_ = weighted < shortest_ ? weighted : shortest_;
    std::uint32_t weakest = 0;
    for (std::uint32_t i = 0; i < ways_; ++i) {
      if (same(scratch_.ways[i].length, length) &&
          dot(scratch_.ways[i].normal, normal) > 1 - kSame) {
        if (way.strength > scratch_.ways[i].strength) scratch_.ways[i].strength = way.strength;
        if (way.facing > scratch_.ways[i].facing) scratch_.ways[i].facing = way.facing;
        return;
      }
      if (scratch_.ways[i].strength < scratch_.ways[weakest].strength) weakest = i;
    }
    if (ways_ < kMostWays) {
      scratch_.ways[ways_++] = way;
    } else if (way.strength > scratch_.ways[weakest].strength) {
      scratch_.ways[weakest] = way;
    }
  }

  /// Beside a concave edge or vertex each face counts.
  void add_beside(const Foot& foot, Vec3d apart, double distance) noexcept {
    const Surface& target = side_.target.surface;
    const std::uint32_t i = which(foot.feature);
    const auto beside = [&](Vec3d normal) {
      const double ahead = dot(normal, apart);
      const double aside = norm(apart - ahead * normal);
      const double size = ahead < 0 ? -ahead : ahead;
      const double unit = size > delta_ ? size : delta_;
      double weight = clamp01((kBesideNone - aside / unit) / (kBesideNone - kBesideWhole));
      weight *= solidity_;
      if (ahead < 0) weight *= directness(depth_, distance);
      add(normal, ahead, weight, foot);
    };
    if (is_corner(foot.feature)) {
      const std::uint32_t vertex = vertex_of(target, foot.triangle, i);
      for (const image::SurfaceNormal& n : concave_normals(target, vertex))
        beside(contact::direction(n));
      return;
    }
    const Edge edge = edge_of(target, 3 * foot.triangle + i);
    if (!edge.concave) return;
    beside(edge.normal);
    beside(edge.other_normal);
  }

  /// Ways out are alternatives: one contact, along the least push of their directions.
  void leave() noexcept {
    const WayOut* only = nullptr;
    std::uint32_t count = 0;
    const WayOut* shortest = nullptr;
    double strongest = 0;
    double length = 0;
    for (std::uint32_t i = 0; i < ways_; ++i) {
      const WayOut& way = scratch_.ways[i];
      const double weighted = way.length / way.facing;
      if (shortest == nullptr || weighted < length) {
        shortest = &way;
        length = weighted;
      }
      if (!(way.strength > 0)) continue;
      strongest = way.strength > strongest ? way.strength : strongest;
      only = &way;
      scratch_.constraints[count++] = {way.normal, way.strength - (1 - way.strength) * kFadedWay};
    }
    if (count == 0) return;
    Foot foot;
    foot.point = shortest->foot;
    foot.triangle = shortest->triangle;
    if (count == 1) {
      add(only->normal, -length, solidity_ * strongest, foot);
      return;
    }
    const Vec3d push = force::least_push({scratch_.constraints, count}).push.vector;
    const double size = norm(push);
    if (!(size > 0)) return;
    const double left = clamp01(kCancelling * size / strongest);
    add((1 / size) * push, -length, solidity_ * left * strongest, foot);
  }

  const Side& side_;
  Pace& pace_;
  std::uint32_t vertex_;
  double delta_;
  double reach_;
  Scratch& scratch_;
  Vec3d x_;
  bool inside_ = false;
  double depth_ = 0;
  double solidity_ = 1;  // of the target, at this depth
  std::uint32_t ways_ = 0;
  std::uint32_t feet_ = 0;       // in scratch_.feet
  double shortest_ = kAnywhere;  // of ways out, by how far they are faced
};

}  // namespace

void FoundContacts::add(const FoundContact& contact) noexcept {
  std::uint32_t lightest = 0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    FoundContact& other = contacts_[i];
    if (same(other.distance, contact.distance) && dot(other.normal, contact.normal) > 1 - kSame) {
      if (contact.weight > other.weight) other = contact;
      return;
    }
    if (other.weight < contacts_[lightest].weight) lightest = i;
  }
  if (count_ < kMostFound) {
    contacts_[count_++] = contact;
  } else if (contact.weight > contacts_[lightest].weight) {
    contacts_[lightest] = contact;
  }
}

SignedDistance contacts_of_vertex(const Side& side, Pace& pace, std::uint32_t vertex,
                                  std::uint32_t hint, double delta, Scratch& scratch) noexcept {
  scratch.found.clear();
  return VertexContacts(side, pace, vertex, delta, scratch).run(hint);
}

}  // namespace palpate::contact

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/contact/facing.hpp"
#include "rt_core/contact/found.hpp"

namespace palpate::contact {
namespace {

/// Equal directions and distances.
constexpr double kSame = 1e-12;
/// Closer points than this have no direction between them.
constexpr double kTouching = 1e-12;
/// Where ways cancel each other, the contact fades below this share of the strongest.
constexpr double kCancelled = 0.5;

/// Distances to the side of a concave edge, in the larger of delta and the distance from the face,
/// up to which the face counts wholly, and from which it does not.
constexpr double kBesideWhole = 0.5;
constexpr double kBesideNone = 1;

bool same(double a, double b) noexcept { return (a < b ? b - a : a - b) < kSame; }

/// The kinship of a direction with weighted ones, in constant time: the polynomial force::kinship()
/// of the cosine between two directions is a sum of products of their monomials.
class KinshipSum {
 public:
  void add(Vec3d direction, double weight) noexcept {
    const Monomials of(direction);
    for (std::uint32_t i = 0; i < kMonomials; ++i) moments_[i] += weight * of.value[i];
  }
  [[nodiscard]] double with(Vec3d direction) const noexcept {
    const Monomials of(direction);
    double sum = 0;
    for (std::uint32_t i = 0; i < kMonomials; ++i) sum += kTimes[i] * moments_[i] * of.value[i];
    return 0.5 * sum;
  }

 private:
  static constexpr std::uint32_t kMonomials = 16;
  /// How often each occurs in the square and in the cube of the cosine.
  static constexpr double kTimes[kMonomials] = {1, 1, 1, 2, 2, 2, 1, 1, 1, 3, 3, 3, 3, 3, 3, 6};
  struct Monomials {
    explicit Monomials(Vec3d v) noexcept
        : value{v.x * v.x,       v.y * v.y,       v.z * v.z,       v.x * v.y,
                v.y * v.z,       v.z * v.x,       v.x * v.x * v.x, v.y * v.y * v.y,
                v.z * v.z * v.z, v.x * v.x * v.y, v.x * v.x * v.z, v.y * v.y * v.x,
                v.y * v.y * v.z, v.z * v.z * v.x, v.z * v.z * v.y, v.x * v.y * v.z} {}
    double value[kMonomials];
  };
  double moments_[kMonomials] = {};
};

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
      at = signed_distance(side_.target, pace_, x_, hint);
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
      add_way(nearest.normal, ahead < 0 ? -ahead : 0, distance, agrees, foot);
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

  void add_way(Vec3d normal, double length, double distance, double agrees,
               const Foot& foot) noexcept {
    const double direct = directness(depth_, distance);
    if (direct == 0 && length / agrees >= shortest_) return;
    const double faced = agrees * clamp01(1 + 2 * faces(normal));
    if (!(faced > 0)) return;
    if (length / faced < shortest_) {
      shortest_ = length / faced;
      shortest_foot_ = foot;
    }
    const WayOut way{normal, direct * faced};
    if (!(way.strength > 0)) return;
    if (ways_ < kMostWays) {
      scratch_.ways[ways_++] = way;
      return;
    }
    std::uint32_t weakest = 0;
    for (std::uint32_t i = 1; i < ways_; ++i) {
      if (scratch_.ways[i].strength < scratch_.ways[weakest].strength) weakest = i;
    }
    if (way.strength > scratch_.ways[weakest].strength) scratch_.ways[weakest] = way;
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

  /// Ways out are alternatives: one contact, along their mean. Ways that are akin share one say, so
  /// that it does not matter into how many triangles a surface is cut.
  void leave() noexcept {
    KinshipSum kin;
    double strongest = 0;
    for (std::uint32_t i = 0; i < ways_; ++i) {
      const WayOut& way = scratch_.ways[i];
      kin.add(way.normal, way.strength);
      strongest = way.strength > strongest ? way.strength : strongest;
    }
    Vec3d push{};
    for (std::uint32_t i = 0; i < ways_; ++i) {
      const WayOut& way = scratch_.ways[i];
      push += (way.strength * way.strength / kin.with(way.normal)) * way.normal;
    }
    const double size = norm(push);
    if (!(size > 0)) return;
    const double left = clamp01(size / (kCancelled * strongest));
    add((1 / size) * push, -shortest_, solidity_ * left * strongest, shortest_foot_);
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
  Foot shortest_foot_;
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

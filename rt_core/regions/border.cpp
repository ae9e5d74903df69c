// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/border.hpp"

#include "rt_core/geometry/smooth_step.hpp"
#include "rt_core/regions/around.hpp"

namespace palpate::regions {
namespace {

/// How far a direction leads along the steepest of the ways over a sector. 0 where all lead away
/// from it.
double along_sector(Vec3d direction, const Sector& sector) noexcept {
  const Vec3d normal = sector.normal;
  const double area2 = squared_norm(normal);
  if (!(area2 > 0)) return 0;
  const Vec3d in_plane = direction - (dot(direction, normal) / area2) * normal;
  if (dot(cross(sector.from, in_plane), normal) >= 0 &&
      dot(cross(in_plane, sector.to), normal) >= 0) {
    return norm(in_plane);
  }
  const double from = dot(direction, sector.from) / norm(sector.from);
  const double to = dot(direction, sector.to) / norm(sector.to);
  const double most = from > to ? from : to;
  return most > 0 ? most : 0;
}

/// Each leaves the square of the cosine between two edges of what is wrong: at 45 degrees 1/256.
constexpr int kTurns = 8;

/// Squared sine; a direction that turns by less stays. Most do within three turns.
constexpr double kTurnedLittle2 = 1e-12;

/// Over a corner that is seen from within all ways lead on, and what is left of a direction that is
/// turned off them leads anywhere. Cosines: a normal that has turned farther than the first is not
/// believed, and less than the second wholly.
constexpr double kNotBelieved = 0.5;
constexpr double kBelieved = 0.7;

Vec3d as_far_as_believed(Vec3d turned, Vec3d normal) noexcept {
  const double cosine = dot(turned, normal);
  if (cosine >= kBelieved) return turned;
  const double share = smooth_step((cosine - kNotBelieved) / (kBelieved - kNotBelieved));
  const Vec3d mean = normal + share * (turned - normal);
  return (1 / norm(mean)) * mean;
}

bool turned(Vec3d before, Vec3d after) noexcept {
  return squared_norm(cross(before, after)) >
         kTurnedLittle2 * squared_norm(before) * squared_norm(after);
}

Foot foot_of(const Place& place) noexcept {
  return foot_at(place.image, place.triangle, place.point);
}

/// Turns a direction off the ways on over a surface, one after the other.
/// @param foot   of the place; not on a face
/// @param known  a normal, if any is known. A place that is on two features to rounding may be
///               taken for the one that it is none of: it is not turned off farther than that
void turn_off(const Place& place, const Foot& foot, Vec3d known, Vec3d& direction) noexcept {
  const auto turn = [&](Vec3d way) {
    const double allowed = dot(known, way);
    const double along = dot(direction, way) - (allowed > 0 ? allowed : 0);
    if (along > 0) direction -= (along / squared_norm(way)) * way;
  };
  const auto turn_off_sector = [&](const Sector& sector) {
    turn(sector.from);
    turn(sector.to);
    if (foot.at.kind == Feature::Kind::edge) {
      turn(cross(sector.normal, sector.from));
    }
  };
  turn_off_sector(sector_at(place.image, foot.triangle, foot.at));
  visit_around(place.image, foot, place.point, turn_off_sector);
}

}  // namespace

Fall fall_across(const Place& place, Vec3d direction) noexcept {
  const auto triangles = place.image.region_triangles;
  const std::uint32_t own = triangles[place.triangle].region;
  const Foot foot = foot_of(place);
  Fall fall;
  if (foot.at.kind == Feature::Kind::face) return fall;
  const auto see = [&](const Sector& sector) {
    const std::uint32_t region = triangles[sector.triangle].region;
    if (region == own) return;
    const double rate = along_sector(-direction, sector);
    if (rate > fall.rate) fall = {rate, region};
  };
  see(sector_at(place.image, foot.triangle, foot.at));  // another region's, beside a sliver
  visit_around(place.image, foot, place.point, see);
  return fall;
}

Vec3d common_normal(const Place& a, const Place& b, const Mat3d& b_in_a, Vec3d normal) noexcept {
  const Foot at_a = foot_of(a);
  const Foot at_b = foot_of(b);
  if (at_a.at.kind == Feature::Kind::face || at_b.at.kind == Feature::Kind::face) return normal;
  const Mat3d to_b = transpose(b_in_a);
  const Vec3d known = to_b * normal;
  Vec3d found = known;
  for (int turn = 0; turn < kTurns; ++turn) {
    const Vec3d before = found;
    Vec3d of_a = -(b_in_a * found);
    turn_off(a, at_a, {}, of_a);
    found = -(to_b * of_a);
    turn_off(b, at_b, known, found);
    if (!turned(before, found)) break;
  }
  const double length = norm(found);
  return length > 0 ? as_far_as_believed((1 / length) * (b_in_a * found), normal) : normal;
}

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/likely.hpp"

#include "rt_core/contact/facing.hpp"
#include "rt_core/contact/nearby.hpp"
#include "rt_core/force/wrench.hpp"

namespace palpate::regions {
namespace {

/// A contact stays too weak for as long as motion and changes of the push leave this share of what
/// it is short of: normals change, too.
constexpr double kRests = 0.5;
/// A vertex that does not face the surface rests for so many delta.
constexpr double kTurnedAway = 0.05;

constexpr double kNothing = 1e300;

float larger(float a, float b) noexcept { return a > b ? a : b; }

Vec3f read(const float* xyz) noexcept { return {xyz[0], xyz[1], xyz[2]}; }

Mat3f to_float(const Mat3d& m) noexcept {
  return {vec_cast<float>(m.row0), vec_cast<float>(m.row1), vec_cast<float>(m.row2)};
}

/// Where a point is by one triangle, in image coordinates.
struct Place {
  float distance = 0;  ///< signed
  Vec3f normal{};      ///< unit: the direction in which it is away, or was on its way in
};

/// Whether a point lies over a triangle, seen along its normal.
bool is_over(const image::RegionTriangle& t, Vec3f normal, Vec3f x) noexcept {
  const Vec3f a = read(t.corners);
  const Vec3f b = read(t.corners + 3);
  const Vec3f c = read(t.corners + 6);
  return dot(cross(b - a, x - a), normal) >= 0 && dot(cross(c - b, x - b), normal) >= 0 &&
         dot(cross(a - c, x - c), normal) >= 0;
}

/// The foot of a point on a triangle or, where that lies on an edge, on the neighbour beyond it if
/// that is nearer: a cell of the grid may be over several wide triangles, and names one of them.
contact::Foot nearby_foot(const contact::Surface& surface, std::uint32_t triangle,
                          Vec3d x) noexcept {
  const contact::Foot foot = contact::closest_point(surface, triangle, x);
  if (!contact::is_edge(foot.feature)) return foot;
  const std::uint32_t beyond =
      contact::neighbour_of(surface, triangle, contact::which(foot.feature));
  if (beyond == image::kNone) return foot;
  const contact::Foot next = contact::closest_point(surface, beyond, x);
  return next.squared < foot.squared ? next : foot;
}

/// How much the faces about a vertex face a direction, the nearest of them or their mean.
float facing_cosine(const ImageView& image, const image::SurfaceVertex& v,
                    Vec3f direction) noexcept {
  float most = dot(read(v.pseudonormal), direction);
  for (std::uint32_t i = 0; i < v.hull_normals; ++i) {
    most = larger(most, dot(read(image.vertex_normals[v.first_normal + i].xyz), direction));
  }
  return most;
}

}  // namespace

LikelyContacts::LikelyContacts(const SideView& view, std::uint32_t side, LikelyMemory& memory,
                               const PushSoFar& push) noexcept
    : view_(view),
      target_(view.side.target.surface),
      memory_(memory),
      push_(push),
      side_(side),
      odometer_(view.odometer + push.changed_m / view.unit_m) {}

LikelyContacts::Placement LikelyContacts::placement() const noexcept {
  return {to_float(view_.side.rotation),
          vec_cast<float>((1 / target_.scale) * view_.side.translation),
          static_cast<float>(view_.side.points.scale / target_.scale)};
}

double LikelyContacts::promise(std::uint32_t region) const noexcept {
  const LikelyRegion& r = memory_.regions[region];
  return r.promise + 0.5 * (odometer_ - r.promised_at);
}

void LikelyContacts::promise_by_distance(std::uint32_t region, double lower,
                                         double radius) noexcept {
  LikelyRegion& r = memory_.regions[region];
  r.promise = view_.delta - (lower + 0.5 * radius);
  r.promised_at = odometer_;
  r.until = lower > view_.delta ? lower - view_.delta + odometer_ : odometer_;
}

std::uint32_t LikelyContacts::look(std::uint32_t region, std::span<LikelyContact> out,
                                   std::uint32_t& count) noexcept {
  LikelyRegion& r = memory_.regions[region];
  const image::SurfaceRun run = view_.image().surface_runs[region];
  const Placement placed = placement();
  double least = kNothing;
  double nearest = kNothing;
  double strongest = 0;
  std::uint32_t looked = 0;
  for (std::uint32_t i = 0; i < run.vertices && count < out.size(); ++i) {
    double& until = memory_.vertices[run.first_vertex + i];
    if (!(until > odometer_)) {
      const double distance = look_at(placed, run.first_vertex + i, out[count]);
      until = rest_of(distance, out[count]) + odometer_;
      nearest = distance < nearest ? distance : nearest;
      const double strength = static_cast<double>(out[count].strength_m) / view_.unit_m;
      strongest = strength > strongest ? strength : strongest;
      if (strength > 0) ++count;
      ++looked;
    }
    least = until < least ? until : least;
  }
  r.until = least;
  r.promise = strongest > 0 || nearest < view_.delta ? strongest : view_.delta - nearest;
  r.promised_at = odometer_;
  return looked;
}

double LikelyContacts::rest_of(double distance, const LikelyContact& contact) const noexcept {
  if (!(contact.strength_m > 0)) {
    const double beyond = distance - view_.delta;
    return beyond > 0 ? beyond : kTurnedAway * view_.delta;
  }
  const double short_of_m = force::kTakesPart * push_.push.along(vec_cast<double>(contact.push)) -
                            static_cast<double>(contact.strength_m);
  return short_of_m > 0 ? kRests * short_of_m / view_.unit_m : 0;
}

double LikelyContacts::look_at(const Placement& placed, std::uint32_t vertex,
                               LikelyContact& out) const noexcept {
  out.strength_m = 0;
  const ImageView& points = view_.image();
  const image::SurfaceVertex& v = points.surface_vertices[vertex];
  const Vec3f x = placed(read(v.position));
  const std::uint32_t triangle = contact::cell_at(*target_.image, x).triangle;
  const image::RegionTriangle& t = target_.image->region_triangles[triangle];
  const Vec3f corner = read(t.corners);
  const Vec3f normal = cross(read(t.corners + 3) - corner, read(t.corners + 6) - corner);
  const float length = norm(normal);
  if (!(length > 0)) return 0;
  Place place{dot(normal, x - corner) / length, (1 / length) * normal};
  const auto delta = static_cast<float>(view_.delta / target_.scale);
  const bool behind = place.distance < 0 && contact::is_open(target_);
  if (place.distance < delta && (behind || !is_over(t, normal, x))) {
    const Vec3d at = target_.scale * vec_cast<double>(x);
    const contact::Foot foot = nearby_foot(target_, triangle, at);
    const double distance = contact::signed_by(target_, foot, at);
    if (distance != 0) {
      place.normal = vec_cast<float>((1 / distance) * (at - foot.point));
      place.distance = static_cast<float>(distance / target_.scale);
    }
  }
  const double distance = static_cast<double>(place.distance) * target_.scale;
  if (place.distance >= delta) return distance;
  const float cosine = facing_cosine(points, v, transpose(placed.turn) * (-place.normal));
  const double weight = contact::facing(static_cast<double>(cosine)) *
                        contact::solidity(target_, distance < 0 ? -distance : 0);
  out.strength_m = static_cast<float>(weight * (view_.delta - distance) * view_.unit_m);
  out.weight = static_cast<float>(weight);
  const Vec3d push = view_.to_world * vec_cast<double>(place.normal);
  out.push = vec_cast<float>(view_.points_of_tool ? push : -push);
  out.source = {side_, vertex};
  return distance;
}

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/likely.hpp"

#include "rt_core/contact/facing.hpp"
#include "rt_core/contact/proximity.hpp"

namespace palpate::regions {
namespace {

/// A push exceeds a strength for as long as motion and changes of the push leave this share of what
/// it exceeds it by: normals change, too.
constexpr double kRests = 0.5;

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

LikelyContacts::LikelyContacts(const SideView& view, std::uint32_t side, const LikelyMemory& memory,
                               const PushSoFar& push) noexcept
    : view_(view),
      target_(view.side.target.surface),
      memory_(memory),
      push_(push),
      side_(side),
      odometer_(view.odometer + push.changed_m / view.unit_m),
      turn_(to_float(view.side.rotation)),
      move_(vec_cast<float>((1 / target_.scale) * view.side.translation)),
      scale_(static_cast<float>(view.side.points.scale / target_.scale)) {}

double LikelyContacts::distance_of_centre(std::uint32_t region) const noexcept {
  const Sphere sphere = sphere_of(view_, region);
  const Vec3d x = view_.side.to_target(sphere.centre);
  const contact::Foot foot = contact::closest_point(target_, contact::triangle_near(target_, x), x);
  const bool inside = dot(x - foot.point, contact::pseudonormal(target_, foot)) < 0;
  return (inside ? -1 : 1) * sqrt_of(foot.squared) - sphere.radius;
}

std::uint32_t LikelyContacts::look(std::uint32_t region, std::span<LikelyContact> out,
                                   std::uint32_t& count) noexcept {
  double& region_until = memory_.regions[region];
  if (region_until > odometer_) return 0;
  const double beyond = distance_of_centre(region) - view_.delta;
  if (beyond > 0) {
    region_until = beyond + odometer_;
    return 1;
  }
  const image::SurfaceRun run = view_.image().surface_runs[region];
  double least = kNothing;
  std::uint32_t looked = 1;
  for (std::uint32_t i = 0; i < run.vertices && count < out.size(); ++i) {
    double& until = memory_.vertices[run.first_vertex + i];
    if (!(until > odometer_)) {
      const double distance = look_at(run.first_vertex + i, out[count]);
      until = rest_of(distance, out[count]) + odometer_;
      if (out[count].strength_m > 0) ++count;
      ++looked;
    }
    least = until < least ? until : least;
  }
  region_until = least;
  return looked;
}

double LikelyContacts::rest_of(double distance, const LikelyContact& contact) const noexcept {
  if (!(contact.strength_m > 0)) return distance > view_.delta ? distance - view_.delta : 0;
  const double exceeded_m =
      push_.push.along(vec_cast<double>(contact.push)) - static_cast<double>(contact.strength_m);
  return exceeded_m > 0 ? kRests * exceeded_m / view_.unit_m : 0;
}

double LikelyContacts::look_at(std::uint32_t vertex, LikelyContact& out) const noexcept {
  out.strength_m = 0;
  const ImageView& points = view_.image();
  const image::SurfaceVertex& v = points.surface_vertices[vertex];
  const Vec3f x = scale_ * (turn_ * read(v.position)) + move_;
  const std::uint32_t triangle = contact::triangle_near(*target_.image, x);
  const image::RegionTriangle& t = target_.image->region_triangles[triangle];
  const Vec3f corner = read(t.corners);
  const Vec3f normal = cross(read(t.corners + 3) - corner, read(t.corners + 6) - corner);
  const float length = norm(normal);
  if (!(length > 0)) return 0;
  Place place{dot(normal, x - corner) / length, (1 / length) * normal};
  const auto delta = static_cast<float>(view_.delta / target_.scale);
  if (place.distance >= delta) return static_cast<double>(place.distance) * target_.scale;
  if (!is_over(t, normal, x)) {
    const Vec3d at = target_.scale * vec_cast<double>(x);
    const contact::Foot foot = contact::closest_point(target_, triangle, at);
    const Vec3d apart = at - foot.point;
    const double distance = sqrt_of(foot.squared);
    const bool inside = dot(apart, contact::pseudonormal(target_, foot)) < 0;
    if (distance > 0) {
      place.normal = vec_cast<float>((inside ? -1 / distance : 1 / distance) * apart);
      place.distance = static_cast<float>((inside ? -distance : distance) / target_.scale);
    }
  }
  const double distance = static_cast<double>(place.distance) * target_.scale;
  if (place.distance >= delta) return distance;
  const float cosine = facing_cosine(points, v, transpose(turn_) * (-place.normal));
  const double weight = contact::facing(static_cast<double>(cosine));
  out.strength_m = static_cast<float>(weight * (view_.delta - distance) * view_.unit_m);
  out.weight = static_cast<float>(weight);
  const Vec3d push = view_.to_world * vec_cast<double>(place.normal);
  out.push = vec_cast<float>(view_.points_of_tool ? push : -push);
  out.side = side_;
  out.vertex = vertex;
  return distance;
}

}  // namespace palpate::regions

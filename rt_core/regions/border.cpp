// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/border.hpp"

#include "rt_core/regions/around.hpp"

namespace palpate::regions {
namespace {

/// How far a direction leads along the steepest of the ways over a sector. 0 where all lead away
/// from it.
double along_sector(Vec3d direction, const Sector& sector, Vec3d normal) noexcept {
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

}  // namespace

Fall fall_across(const ImageView& image, std::uint32_t triangle, Vec3d point,
                 Vec3d direction) noexcept {
  const std::uint32_t own = image.region_triangles[triangle].region;
  Fall fall;
  visit_around(image, triangle, point, [&](const Sector& sector) {
    const image::RegionTriangle& t = image.region_triangles[sector.triangle];
    if (t.region == own) return;
    const double rate = along_sector(-direction, sector, normal_of(t));
    if (rate > fall.rate) fall = {rate, t.region};
  });
  return fall;
}

}  // namespace palpate::regions

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/relax.hpp"

#include <cassert>
#include <cstddef>

namespace palpate::bake {
namespace {

constexpr double kNoArea = 1e-12;  // height of a flap's triangle over its edge, relative to it

/// A triangle's third vertex, in the plane with the edge's start at 0 and its end at (length, 0).
struct Unfolded {
  double along, height;
};

Unfolded unfold(Vec3d edge, double length, Vec3d to_apex) {
  const double along = dot(edge, to_apex) / length;
  return {along, norm(cross(edge, to_apex)) / length};
}

/// Sums for the minimum of the squared differences in the position of one vertex.
struct Fit {
  Vec3d numerator{};
  double denominator = 0;

  void add(double own, Vec3d others) {
    numerator -= own * others;
    denominator += own * own;
  }
};

}  // namespace

Vec3d relaxed(Vec3d centre, std::span<const Vec3d> ring, std::span<const Vec3d> far,
              std::span<const char> has_far) {
  assert(far.size() == ring.size() && has_far.size() == ring.size());
  Fit fit;
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d here = ring[i];
    const Vec3d after = ring[i + 1 == n ? 0 : i + 1];
    const Vec3d before = ring[i == 0 ? n - 1 : i - 1];

    const Vec3d spoke = here - centre;
    const double length = norm(spoke);
    if (length > 0) {
      const Unfolded a = unfold(spoke, length, after - centre);
      const Unfolded b = unfold(spoke, length, before - centre);
      if (a.height > kNoArea * length && b.height > kNoArea * length) {
        const double ca = 2 / a.height;
        const double cb = 2 / b.height;
        // Signed areas of the triangles that the other diagonal makes, over those of the flap's.
        const double scale = 2 / (length * a.height * b.height);
        const double c_centre =
            -scale * (a.height * (length - b.along) + b.height * (length - a.along));
        const double c_here = -scale * (a.height * b.along + b.height * a.along);
        fit.add(c_centre, ca * after + cb * before + c_here * here);
      }
    }

    const Vec3d rim = after - here;
    const double width = norm(rim);
    if (!has_far[i] || !(width > 0)) continue;
    const Unfolded a = unfold(rim, width, centre - here);
    const Unfolded b = unfold(rim, width, far[i] - here);
    if (!(a.height > kNoArea * width && b.height > kNoArea * width)) continue;
    const double scale = 2 / (width * a.height * b.height);
    const double c_here = -scale * (a.height * (width - b.along) + b.height * (width - a.along));
    const double c_after = -scale * (a.height * b.along + b.height * a.along);
    fit.add(2 / a.height, (2 / b.height) * far[i] + c_here * here + c_after * after);
  }
  return fit.denominator > 0 ? (1 / fit.denominator) * fit.numerator : centre;
}

}  // namespace palpate::bake

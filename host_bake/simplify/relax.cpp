// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/relax.hpp"

#include <cassert>
#include <cstddef>

namespace palpate::bake {
namespace {

constexpr double kNoArea = 1e-12;  // height of a flap's triangle over its edge, relative to it

/// One of the two triangles at an edge, in the plane with the edge's start at 0.
struct Flank {
  double area;   // of the parallelogram that edge and apex span
  double along;  // edge . apex
};

/// A flap unfolded about its edge: how the second difference weighs the edge's ends. All
/// coefficients are without their common factor 2 / (|edge| a.area b.area), whose square is
/// `weight`; so areas are the only roots taken.
struct Flap {
  double start, end;  // negated
  double weight;
  bool counts;

  Flap(double squared_length, Flank a, Flank b)
      : start(a.area * (squared_length - b.along) + b.area * (squared_length - a.along)),
        end(a.area * b.along + b.area * a.along),
        weight(0),
        counts(a.area > kNoArea * squared_length && b.area > kNoArea * squared_length) {
    const double areas = a.area * b.area;
    if (counts) weight = 4 / (squared_length * areas * areas);
  }
};

}  // namespace

Vec3d relaxed(Vec3d centre, std::span<const Vec3d> ring, std::span<const Vec3d> far,
              std::span<const char> has_far) {
  assert(far.size() == ring.size() && has_far.size() == ring.size());
  const std::size_t n = ring.size();
  if (n == 0) return centre;
  Vec3d numerator{};
  double denominator = 0;
  Vec3d before = ring[n - 1] - centre, here = ring[0] - centre;  // all relative to the centre
  double area_before = norm(cross(before, here));
  double along_before = dot(before, here);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d after = ring[i + 1 == n ? 0 : i + 1] - centre;
    const double area = norm(cross(here, after));
    const double along = dot(here, after);

    const double spoke = dot(here, here);
    if (const Flap flap(spoke, {area, along}, {area_before, along_before}); flap.counts) {
      const Vec3d others = spoke * (area_before * after + area * before) - flap.end * here;
      numerator += (flap.weight * flap.start) * others;
      denominator += flap.weight * flap.start * flap.start;
    }

    const Vec3d rim = after - here;
    const double width = dot(rim, rim);
    if (has_far[i]) {
      const Vec3d apex = far[i] - ring[i];
      const Flank other = {norm(cross(rim, apex)), dot(rim, apex)};
      if (const Flap flap(width, {area, spoke - along}, other); flap.counts) {
        const double own = width * other.area;
        const Vec3d others =
            (width * area) * (far[i] - centre) - flap.start * here - flap.end * after;
        numerator -= (flap.weight * own) * others;
        denominator += flap.weight * own * own;
      }
    }
    before = here;
    here = after;
    area_before = area;
    along_before = along;
  }
  return denominator > 0 ? centre + (1 / denominator) * numerator : centre;
}

}  // namespace palpate::bake

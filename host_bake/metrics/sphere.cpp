// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/sphere.hpp"

#include <CGAL/Min_sphere_of_points_d_traits_3.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using MinSphere =
    CGAL::Min_sphere_of_spheres_d<CGAL::Min_sphere_of_points_d_traits_3<Kernel, double>>;

// A distance computed in float from float differences is off by at most 4 units of 2^-24,
// relatively; twice that, and the double arithmetic of this file is covered too.
constexpr double kRoundingMargin = 8.0 / 16777216.0;

PointF box_centre(std::span<const PointF> points) {
  PointF low = points[0], high = points[0];
  for (const PointF& p : points) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
}

Sphere about(const PointF& centre, std::span<const PointF> points) {
  double largest = 0;
  for (const PointF& p : points) largest = std::max(largest, norm(vec(p) - vec(centre)));
  const double wanted = largest * (1 + kRoundingMargin);
  auto radius = static_cast<float>(wanted);
  if (static_cast<double>(radius) < wanted)
    radius = std::nextafter(radius, std::numeric_limits<float>::infinity());
  return {centre, radius};
}

PointF smallest_sphere_centre(std::span<const PointF> points) {
  std::vector<Kernel::Point_3> input;
  input.reserve(points.size());
  for (const PointF& p : points) input.emplace_back(p[0], p[1], p[2]);
  MinSphere sphere(input.begin(), input.end());
  PointF centre{};
  std::transform(sphere.center_cartesian_begin(), sphere.center_cartesian_end(), centre.begin(),
                 [](double v) { return static_cast<float>(v); });
  return centre;
}

}  // namespace

Sphere bounding_sphere(std::span<const PointF> points) {
  const Sphere of_box = about(box_centre(points), points);
  const Sphere smallest = about(smallest_sphere_centre(points), points);
  // The solver works in double without a guarantee: a slip may cost tightness (or give NaN), never
  // correctness.
  return smallest.radius <= of_box.radius ? smallest : of_box;
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>

#include "host_bake/hull/facets.hpp"
#include "host_bake/hull/growing_hull.hpp"
#include "host_bake/hull/hull.hpp"
#include "host_bake/hull/quickhull.hpp"

namespace palpate::bake {
namespace {

// Inserting one by one looks at every facet; measured equal to CGAL near 40 points.
constexpr std::size_t kSmall = 32;

/// The lowest index of each position, ordered by position.
std::vector<std::uint32_t> distinct(std::span<const PointF> points) {
  std::vector<std::uint32_t> ids(points.size());
  std::iota(ids.begin(), ids.end(), 0u);
  std::sort(ids.begin(), ids.end(), [&](std::uint32_t a, std::uint32_t b) {
    return points[a] != points[b] ? points[a] < points[b] : a < b;
  });
  ids.erase(std::unique(ids.begin(), ids.end(),
                        [&](std::uint32_t a, std::uint32_t b) { return points[a] == points[b]; }),
            ids.end());
  return ids;
}

/// Three points that span a plane, and one off it; as far as there are such.
struct Frame {
  std::optional<std::uint32_t> third, fourth;
};

Frame find_frame(std::span<const PointF> points, std::span<const std::uint32_t> ids) {
  Frame frame;
  for (std::size_t i = 2; i < ids.size(); ++i) {
    const PointF& p = points[ids[i]];
    if (!frame.third) {
      if (!collinear(points[ids[0]], points[ids[1]], p)) frame.third = ids[i];
    } else if (orient_3d(points[ids[0]], points[ids[1]], points[*frame.third], p) != 0) {
      frame.fourth = ids[i];
      break;
    }
  }
  return frame;
}

std::vector<Triangle> grow(std::span<const PointF> points, std::span<const std::uint32_t> ids,
                           const Frame& frame) {
  GrowingHull hull(points);
  const std::uint32_t base[] = {ids[0], ids[1], *frame.third};
  hull.start(base, false);
  bool all = hull.insert(*frame.fourth, GrowingHull::kNone);
  for (const std::uint32_t id : ids) all = hull.insert(id, GrowingHull::kNone) && all;
  // No facet is real, so none was refused.
  return all ? hull.triangles() : std::vector<Triangle>{};
}

}  // namespace

HullMesh convex_hull(std::span<const PointF> points) {
  const std::vector<std::uint32_t> ids = distinct(points);
  const Frame frame = find_frame(points, ids);
  if (!frame.fourth) {
    const Projection view =
        frame.third ? projection_of(points[ids[0]], points[ids[1]], points[*frame.third])
                    : Projection{};
    return canonical_flat_hull(flat_ring(points, ids, view));
  }
  const std::vector<Triangle> triangles =
      ids.size() <= kSmall ? grow(points, ids, frame) : quickhull(points, ids);
  return canonical_hull(points, triangles).mesh;
}

}  // namespace palpate::bake

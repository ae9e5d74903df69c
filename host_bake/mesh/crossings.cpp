// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/crossings.hpp"

#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>
#include <tbb/concurrent_vector.h>

#include <algorithm>
#include <array>
#include <atomic>

#include "host_bake/mesh/cgal_point.hpp"

namespace palpate::bake {
namespace {

using Kernel = CgalKernel;
using Point3 = Kernel::Point_3;
using BoxedFace = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// Leaves the search from inside its callback.
struct TooManyMeetings {};

/// Two triangles as six points, the shared ones first and in the same places of both.
struct Couple {
  std::array<Point3, 3> a, b;
  int shared = 0;
};

Couple align(std::array<Point, 3> a, std::array<Point, 3> b) {
  Couple couple;
  const auto place = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
  for (std::size_t s = 0; s < 3; ++s) {
    const auto at = static_cast<std::size_t>(couple.shared);
    const auto in_b = std::find(b.begin() + place(at), b.end(), a[s]);
    if (in_b == b.end()) continue;
    std::iter_swap(in_b, b.begin() + place(at));
    std::swap(a[s], a[at]);
    ++couple.shared;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    couple.a[i] = to_cgal(a[i]);
    couple.b[i] = to_cgal(b[i]);
  }
  return couple;
}

/// With a common vertex, any further common point lies on the far side of one triangle or on the
/// other's.
bool cross_beyond_vertex(const Couple& c) {
  const Kernel::Triangle_3 a(c.a[0], c.a[1], c.a[2]);
  const Kernel::Triangle_3 b(c.b[0], c.b[1], c.b[2]);
  return CGAL::do_intersect(a, Kernel::Segment_3(c.b[1], c.b[2])) ||
         CGAL::do_intersect(b, Kernel::Segment_3(c.a[1], c.a[2]));
}

/// With a common edge, they overlap only when in one plane and on the same side of the edge.
bool fold_over_edge(const Couple& c) {
  return CGAL::coplanar(c.a[0], c.a[1], c.a[2], c.b[2]) &&
         CGAL::coplanar_orientation(c.a[0], c.a[1], c.a[2], c.b[2]) == CGAL::POSITIVE;
}

}  // namespace

bool triangles_cross(const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
  if (collinear(a[0], a[1], a[2]) || collinear(b[0], b[1], b[2])) return false;
  const Couple c = align(a, b);
  switch (c.shared) {
    case 0:
      return CGAL::do_intersect(Kernel::Triangle_3(c.a[0], c.a[1], c.a[2]),
                                Kernel::Triangle_3(c.b[0], c.b[1], c.b[2]));
    case 1:
      return cross_beyond_vertex(c);
    case 2:
      return fold_over_edge(c);
    default:
      return true;
  }
}

bool collinear(const Point& a, const Point& b, const Point& c) {
  return CGAL::collinear(to_cgal(a), to_cgal(b), to_cgal(c));
}

#if defined(PALPATE_THREAD_SANITIZER)
// CGAL's threads are not ours, and the sanitizer cannot see into the oneTBB that joins them.
using Concurrency = CGAL::Sequential_tag;
#else
using Concurrency = CGAL::Parallel_tag;
#endif

std::optional<std::vector<Pair>> crossing_pairs(const Mesh& mesh) {
  const auto corners = [&mesh](std::uint32_t face) {
    const Face& f = mesh.faces[face];
    return std::array<Point, 3>{mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]]};
  };
  std::vector<BoxedFace> boxes;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const auto [a, b, c] = corners(f);
    if (collinear(a, b, c)) continue;
    const CGAL::Bbox_3 box = to_cgal(a).bbox() + to_cgal(b).bbox() + to_cgal(c).bbox();
    boxes.emplace_back(box, f);
  }
  const std::size_t limit = kMaxMeetings + kMaxMeetingsPerFace * mesh.faces.size();
  std::atomic<std::size_t> meetings{0};
  tbb::concurrent_vector<Pair> found;
  try {
    CGAL::box_self_intersection_d<Concurrency>(
        boxes.begin(), boxes.end(), [&](const BoxedFace& a, const BoxedFace& b) {
          if (meetings.fetch_add(1, std::memory_order_relaxed) >= limit) throw TooManyMeetings{};
          if (!triangles_cross(corners(a.info()), corners(b.info()))) return;
          found.push_back(std::minmax(a.info(), b.info()));
        });
  } catch (const TooManyMeetings&) {
    return std::nullopt;
  }
  std::vector<Pair> pairs(found.begin(), found.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace palpate::bake

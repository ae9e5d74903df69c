// SPDX-License-Identifier: GPL-3.0-or-later
// Constraint 3 of Sec. 4.3.
#include <CGAL/Bbox_3.h>
#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <optional>
#include <tuple>
#include <vector>

#include "host_bake/metrics/vector.hpp"
#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {
namespace {

using Corners = std::array<Vec3d, 3>;

struct HalfSpace {
  Vec3d normal;  // unit
  double offset;
};

// The interior of a solid hull, shrunk: intersection of half spaces.
class ShrunkHull {
 public:
  ShrunkHull(std::span<const PointF> points, const HullMesh& hull) {
    for (const auto& f : hull.faces) {
      const Vec3d a = vec(points[f[0]]);
      const Vec3d n = unit(cross(vec(points[f[1]]) - a, vec(points[f[2]]) - a));
      half_spaces_.push_back({n, dot(n, a) - kIntrusionTolerance});
    }
  }

  // Clips the triangle by one half space after the other until nothing is left. The one that left
  // nothing comes first the next time: triangles are asked about in the order of their places.
  bool is_entered_by(const Corners& triangle) {
    std::vector<Vec3d> polygon(triangle.begin(), triangle.end());
    for (std::size_t i = 0; i < half_spaces_.size(); ++i) {
      clip(polygon, half_spaces_[i]);
      if (!polygon.empty()) continue;
      std::swap(half_spaces_[0], half_spaces_[i]);
      return false;
    }
    return true;
  }

 private:
  static void clip(std::vector<Vec3d>& polygon, const HalfSpace& h) {
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double at_p = dot(h.normal, p) - h.offset, at_q = dot(h.normal, q) - h.offset;
      if (at_p < 0) kept.push_back(p);
      if ((at_p < 0) != (at_q < 0)) kept.push_back(p + (at_p / (at_p - at_q)) * (q - p));
    }
    polygon = std::move(kept);
  }

  std::vector<HalfSpace> half_spaces_;
};

struct LevelTriangle {
  std::uint32_t piece;
  Corners corners;
};

using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;

CGAL::Bbox_3 box_of(std::span<const Vec3d> points) {
  CGAL::Bbox_3 box;
  for (const Vec3d& p : points) box += CGAL::Bbox_3(p.x, p.y, p.z, p.x, p.y, p.z);
  return box;
}

CGAL::Bbox_3 box_of(std::span<const PointF> points) {
  std::vector<Vec3d> doubles(points.size());
  std::transform(points.begin(), points.end(), doubles.begin(),
                 [](const PointF& p) { return vec(p); });
  return box_of(doubles);
}

std::vector<LevelTriangle> triangles_of(const Evidence& evidence,
                                        const std::vector<std::uint32_t>& pieces) {
  std::vector<LevelTriangle> triangles;
  for (const std::uint32_t i : pieces) {
    for (const image::Triangle& t : patch(evidence, evidence.image.pieces[i])) {
      const auto& p = evidence.points[i];
      triangles.push_back(
          {i, {vec(p[t.vertices[0]]), vec(p[t.vertices[1]]), vec(p[t.vertices[2]])}});
    }
  }
  return triangles;
}

using Intrusion =
    std::tuple<std::uint32_t, std::uint32_t>;  // the piece entered, the one that enters

std::optional<Intrusion> first_intrusion(const Evidence& evidence, std::uint32_t level) {
  const std::vector<std::uint32_t> alive = alive_at(evidence.image, level);
  const std::vector<LevelTriangle> triangles = triangles_of(evidence, alive);
  std::vector<Box> triangle_boxes, hull_boxes;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    triangle_boxes.emplace_back(box_of(triangles[i].corners), i);
  std::vector<std::pair<std::uint32_t, ShrunkHull>> hulls;
  for (const std::uint32_t i : alive) {
    if (evidence.hulls[i].dimension != 3) continue;
    hull_boxes.emplace_back(box_of(hull_points(evidence, i)), hulls.size());
    hulls.emplace_back(i, ShrunkHull(hull_points(evidence, i), evidence.hulls[i]));
  }
  std::optional<Intrusion> first;
  CGAL::box_intersection_d(hull_boxes.begin(), hull_boxes.end(), triangle_boxes.begin(),
                           triangle_boxes.end(), [&](const Box& hull_box, const Box& triangle_box) {
                             auto& [piece, hull] = hulls[hull_box.info()];
                             const LevelTriangle& triangle = triangles[triangle_box.info()];
                             const Intrusion found{piece, triangle.piece};
                             if (triangle.piece == piece || (first && *first <= found)) return;
                             if (hull.is_entered_by(triangle.corners)) first = found;
                           });
  return first;
}

}  // namespace

Proof prove_no_intrusion(const Evidence& evidence) {
  const std::string invariant = "no triangle of a level enters the hull of another patch";
  std::size_t levels = 0;
  for (std::uint32_t level = 0; level < evidence.image.levels.size(); ++level) {
    if (evidence.image.levels[level].free != 0) continue;
    ++levels;
    if (const auto found = first_intrusion(evidence, level)) {
      const auto [entered, entering] = *found;
      return {invariant, false,
              "piece " + std::to_string(entered) + " is entered by a triangle of piece " +
                  std::to_string(entering)};
    }
  }
  return {invariant, true, std::to_string(levels) + (levels == 1 ? " level" : " levels")};
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
// What enters the hull of many points, without building that hull.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host_bake/hull/growing_hull.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

enum class Entry : std::uint8_t {
  no,
  yes,
  unknown,  ///< would cost more than the whole hull
};

/// A plane that bounds a half-space.
struct BoundingPlane {
  Vec3d normal;   ///< unit, outward
  double offset;  ///< normal . x at most, but for rounding

  [[nodiscard]] bool holds(Vec3d p) const {
    constexpr double kRounding = 1e-12;  // kShrink_rel is far more
    return dot(normal, p) <= offset + kRounding;
  }
};

/// The hull of a few of the points, to which others are added as questions need them: a triangle
/// that enters the small hull enters the whole one, and one that the small hull's planes keep out
/// is out where all points are below those planes.
class LazyHull {
 public:
  /// Begins with some of the points, best those near to the triangles to come, and the ones
  /// farthest out along the axes. The points must outlive the questions. O(points).
  void start(std::span<const PointF> points, std::span<const std::uint32_t> near);

  /// Something is left of the triangle after clipping by the whole hull, shrunk by kShrink_rel.
  /// O(points) for each point added, and most questions need but a few.
  Entry entered_by(const std::array<PointF, 3>& triangle);

  /// Where the last answer was no: planes that hold all points, and shrunk leave nothing of the
  /// triangle. They will do so for other points that they hold.
  [[nodiscard]] std::vector<BoundingPlane> keepers() const;

 private:
  static constexpr std::size_t kMost = 128;  // points of the small hull
  void add(const PointF& point);
  void find_planes();
  [[nodiscard]] bool is_left_of(const std::array<PointF, 3>& triangle);
  [[nodiscard]] bool add_beyond_cutters();

  std::span<const PointF> points_;
  std::vector<PointF> small_ = std::vector<PointF>(kMost);
  std::size_t used_ = 0;  // of small_
  std::optional<GrowingHull> hull_;
  bool started_ = false;
  std::vector<BoundingPlane> planes_;
  std::vector<std::size_t> cutters_;  // planes that took something from the triangle asked last
  std::vector<Vec3d> polygon_, clipped_;
};

}  // namespace palpate::bake

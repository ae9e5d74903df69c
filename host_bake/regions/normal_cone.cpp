// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/normal_cone.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_bake/metrics/vector.hpp"
#include "rt_core/image/region_format.hpp"

namespace palpate::bake {
namespace {

constexpr int kMostSteps = 1000;
constexpr double kNarrowed = 1e-9;     // a step that can gain less is the last
constexpr double kLeastCosine = 1e-4;  // below it a cone is no narrower than a half space

/// A point of the convex hull of normals on its way to the one nearest to the origin (Mitchell,
/// Demyanov and Malozemov 1974): what lies farthest along the point gives up weight to what lies
/// least far.
class NearestPoint {
 public:
  explicit NearestPoint(std::span<const Vec3d> normals)
      : normals_(normals), weights_(normals.size(), 1.0 / double(normals.size())) {
    for (const Vec3d& n : normals) point_ += weights_[0] * n;
  }

  [[nodiscard]] Vec3d point() const { return point_; }

  /// @return the least cosine of a normal to the way to the point
  double find_ends() {
    const Vec3d axis = unit(point_);
    double least = 2;
    most_ = -2;
    for (std::size_t i = 0; i < normals_.size(); ++i) {
      const double along = dot(normals_[i], axis);
      if (along < least) {
        least = along;
        last_ = i;
      }
      if (along > most_ && weights_[i] > 0) {
        most_ = along;
        first_ = i;
      }
    }
    return least;
  }

  /// After find_ends(). @return false where there is nothing to gain
  bool step(double least) {
    const Vec3d way = normals_[last_] - normals_[first_];
    const double gain = (most_ - least) * norm(point_);
    const double length2 = squared_norm(way);
    if (gain < kNarrowed || !(length2 > 0)) return false;
    const double moved = std::min(weights_[first_], gain / length2);
    weights_[first_] = moved < weights_[first_] ? weights_[first_] - moved : 0;
    weights_[last_] += moved;
    point_ += moved * way;
    return true;
  }

 private:
  std::span<const Vec3d> normals_;
  std::vector<double> weights_;
  Vec3d point_{};
  double most_ = 0;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
};

/// A normal where the sphere is projected from its centre on the plane across the axis, which
/// keeps straight what is straight.
struct Projected {
  double x = 0;
  double y = 0;
  Vec3d normal{};
};

/// Whether the way from a by b to c turns left, seen from outside.
bool turns_left(const Projected& a, const Projected& b, const Projected& c) {
  return dot(cross(a.normal, b.normal), c.normal) > 0;
}

/// One half of the hull, from the first to the last (monotone chain: Andrew 1979).
template <class Iterator>
void add_chain(Iterator first, Iterator last, std::vector<Projected>& hull) {
  const std::size_t kept = hull.size();
  for (; first != last; ++first) {
    while (hull.size() >= kept + 2 && !turns_left(hull[hull.size() - 2], hull.back(), *first)) {
      hull.pop_back();
    }
    hull.push_back(*first);
  }
  hull.pop_back();  // the other half begins with it
}

/// How far a corner is from the arc between its neighbours.
double height(const Vec3d& before, const Vec3d& corner, const Vec3d& after) {
  const Vec3d pole = unit(cross(before, after));
  const bool beside = dot(cross(pole, before), corner) > 0 && dot(cross(after, pole), corner) > 0;
  return beside ? -dot(corner, pole) : std::min(norm(corner - before), norm(corner - after));
}

/// Without corners that stand out by less than what makes normals one: what is left keeps its shape
/// when it is rounded to float. Of two side by side only one goes at a time, or a round hull would
/// lose all its corners.
void drop_flat_corners(std::vector<Vec3d>& hull) {
  const double least = std::sqrt(2 * (1 - image::kEqualNormalCos));
  for (bool dropped = true; dropped;) {
    dropped = false;
    std::vector<Vec3d> kept;
    bool may_drop = false;  // the first stays, until it is another one's turn
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const std::size_t left = kept.size() + hull.size() - i;
      const Vec3d& next = i + 1 < hull.size() ? hull[i + 1] : hull[0];
      if (may_drop && left > 2 && height(kept.back(), hull[i], next) < least) {
        may_drop = false;
        dropped = true;
        continue;
      }
      may_drop = true;
      kept.push_back(hull[i]);
    }
    std::rotate(kept.begin(), kept.begin() + 1, kept.end());
    hull = std::move(kept);
    // The one that stayed, now the last, has its turn before the end.
    if (!dropped && hull.size() > 2 && height(*(hull.end() - 2), hull.back(), hull[0]) < least) {
      hull.pop_back();
      dropped = true;
    }
  }
}

}  // namespace

NormalCone normal_cone(std::span<const Vec3d> normals) {
  if (normals.empty()) return {};
  NearestPoint nearest(normals);
  NormalCone best;
  for (int i = 0; i < kMostSteps && norm(nearest.point()) > 0; ++i) {
    const double cosine = nearest.find_ends();
    if (cosine > best.cosine) best = {unit(nearest.point()), cosine};
    if (!nearest.step(cosine)) break;
  }
  return best.cosine > kLeastCosine ? best : NormalCone{};
}

std::vector<Vec3d> distinct_normals(std::span<const Vec3d> normals) {
  std::vector<Vec3d> out;
  for (const Vec3d& n : normals) {
    const auto same = [&](const Vec3d& m) { return dot(n, m) > image::kEqualNormalCos; };
    if (std::none_of(out.begin(), out.end(), same)) out.push_back(n);
  }
  return out;
}

std::vector<Vec3d> spherical_hull(std::span<const Vec3d> normals) {
  const NormalCone cone = normal_cone(normals);
  if (cone.axis == Vec3d{}) return {};
  if (normals.size() < 3) return {normals.begin(), normals.end()};
  const Vec3d u = across(cone.axis);
  const Vec3d v = cross(cone.axis, u);
  std::vector<Projected> points;
  points.reserve(normals.size());
  for (const Vec3d& n : normals) {
    const double along = dot(n, cone.axis);
    points.push_back({dot(n, u) / along, dot(n, v) / along, n});
  }
  std::sort(points.begin(), points.end(), [](const Projected& a, const Projected& b) {
    return std::pair(a.x, a.y) < std::pair(b.x, b.y);
  });
  std::vector<Projected> hull;
  add_chain(points.begin(), points.end(), hull);
  add_chain(points.rbegin(), points.rend(), hull);
  std::vector<Vec3d> corners;
  corners.reserve(hull.size());
  for (const Projected& p : hull) corners.push_back(p.normal);
  drop_flat_corners(corners);
  return corners;
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/lazy_hull.hpp"

#include <algorithm>

#include "host_bake/decompose/flat_cover.hpp"
#include "host_bake/decompose/geometry.hpp"
#include "host_bake/hull/predicates.hpp"

namespace palpate::bake {
namespace {

constexpr int kRounds = 32;

}  // namespace

void LazyHull::add(const PointF& point) {
  if (used_ < kMost) small_[used_++] = point;
}

void LazyHull::start(std::span<const PointF> points, std::span<const std::uint32_t> near) {
  points_ = points;
  used_ = 0;
  for (const std::uint32_t v : near.first(std::min(near.size(), kMost / 2))) add(points[v]);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] =
        std::minmax_element(points.begin(), points.end(),
                            [i](const PointF& a, const PointF& b) { return a[i] < b[i]; });
    add(*low);
    add(*high);
  }
  if (!hull_) hull_.emplace(small_);
  started_ = false;
  for (std::uint32_t c = 2; !started_ && c < used_; ++c) {
    if (collinear(small_[0], small_[1], small_[c])) continue;
    const std::array<std::uint32_t, 3> seed = {0, 1, c};
    hull_->start(seed, false);
    started_ = true;
  }
  if (!started_) return;
  // Points in the plane of the first three wait for one off it.
  for (int round = 0; round < 2; ++round)
    for (std::uint32_t v = 0; v < used_; ++v)
      static_cast<void>(hull_->insert(v, GrowingHull::kNone));
  started_ = !hull_->flat();
  if (started_) find_planes();
}

void LazyHull::find_planes() {
  hull_->commit();
  planes_.clear();
  for (const GrowingHull::Facet& facet : hull_->slots()) {
    if (!facet.alive) continue;
    const Vec3d a = position(small_[facet.vertices[0]]);
    const Vec3d n =
        cross(position(small_[facet.vertices[1]]) - a, position(small_[facet.vertices[2]]) - a);
    const Vec3d normal = (1 / norm(n)) * n;
    planes_.push_back({normal, dot(normal, a)});
  }
}

/// Clips by the planes beyond which most of the triangle lies first, so that few are cutters.
bool LazyHull::is_left_of(const std::array<PointF, 3>& triangle) {
  polygon_ = {position(triangle[0]), position(triangle[1]), position(triangle[2])};
  cutters_.clear();
  while (!polygon_.empty()) {
    const auto height = [](const BoundingPlane& plane, Vec3d p) {
      return dot(plane.normal, p) - plane.offset + kShrink_rel;
    };
    std::size_t best = planes_.size();
    double most = 0;
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      double sum = 0, highest = 0;
      for (const Vec3d p : polygon_) {
        const double h = height(planes_[i], p);
        sum += h;
        highest = std::max(highest, h);
      }
      sum /= static_cast<double>(polygon_.size());
      // A plane that all is beyond ends it; others are better the more they cut.
      if (std::find(cutters_.begin(), cutters_.end(), i) != cutters_.end()) continue;
      if (highest > 0 && (best == planes_.size() || sum > most)) {
        best = i;
        most = sum;
      }
    }
    if (best == planes_.size()) return true;
    cutters_.push_back(best);
    clipped_.clear();
    Vec3d previous = polygon_.back();
    double before = height(planes_[best], previous);
    for (const Vec3d p : polygon_) {
      const double now = height(planes_[best], p);
      if ((before > 0) != (now > 0))
        clipped_.push_back(previous + (before / (before - now)) * (p - previous));
      if (!(now > 0)) clipped_.push_back(p);
      previous = p;
      before = now;
    }
    polygon_.swap(clipped_);
  }
  return false;
}

/// Adds the points farthest beyond planes that kept the triangle out; false where there are none.
bool LazyHull::add_beyond_cutters() {
  bool added = false;
  for (const std::size_t c : cutters_) {
    const BoundingPlane& plane = planes_[c];
    double most = plane.offset;
    const PointF* farthest = nullptr;
    for (const PointF& p : points_) {
      const double along = dot(plane.normal, position(p));
      if (along > most) {
        most = along;
        farthest = &p;
      }
    }
    if (farthest == nullptr || plane.holds(position(*farthest))) continue;
    added = true;
    if (used_ == kMost) continue;
    add(*farthest);
    static_cast<void>(hull_->insert(static_cast<std::uint32_t>(used_ - 1), GrowingHull::kNone));
  }
  return added;
}

Entry LazyHull::entered_by(const std::array<PointF, 3>& triangle) {
  if (!started_) return Entry::unknown;
  for (int round = 0; round < kRounds && used_ < kMost; ++round) {
    if (is_left_of(triangle)) return Entry::yes;
    if (!add_beyond_cutters()) return Entry::no;
    find_planes();
  }
  return Entry::unknown;
}

std::vector<BoundingPlane> LazyHull::keepers() const {
  std::vector<BoundingPlane> planes;
  for (const std::size_t c : cutters_) planes.push_back(planes_[c]);
  return planes;
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/shrunk_hull.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "host_bake/decompose/flat_cover.hpp"
#include "host_bake/decompose/geometry.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kSmallHull = 24;  // facets up to which trying all of them beats walking
constexpr float kFar = std::numeric_limits<float>::infinity();

}  // namespace

bool ShrunkHull::small() const { return planes_.size() <= kSmallHull; }

void ShrunkHull::build(const GrowingHull& hull) {
  find_planes(hull);
  find_centre(hull);
  thin_ = false;
  for (std::uint32_t p = 0; p < planes_.size(); ++p)
    if (!(height(p, centre_) < 0)) thin_ = true;
  last_ = 0;
}

void ShrunkHull::find_planes(const GrowingHull& hull) {
  const std::span<const GrowingHull::Facet> slots = hull.slots();
  planes_.clear();
  neighbours_.clear();
  plane_of_slot_.assign(slots.size(), 0);
  box_ = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (std::size_t s = 0; s < slots.size(); ++s) {
    if (!slots[s].alive) continue;
    plane_of_slot_[s] = static_cast<std::uint32_t>(planes_.size());
    const Triangle& t = slots[s].vertices;
    for (const std::uint32_t v : t) box_.add(hull.points()[v]);
    const Vec3d a = position(hull.points()[t[0]]);
    const Vec3d n = cross(position(hull.points()[t[1]]) - a, position(hull.points()[t[2]]) - a);
    const Vec3d normal = (1 / norm(n)) * n;
    planes_.push_back({normal, dot(normal, a) - kShrink_rel});
    neighbours_.push_back(slots[s].neighbours);
  }
  for (auto& around : neighbours_)
    for (std::uint32_t& n : around) n = plane_of_slot_[n];
  visited_.assign(planes_.size(), 0);
  visit_ = 0;
}

void ShrunkHull::find_centre(const GrowingHull& hull) {
  Vec3d origin{};
  double corners = 0;
  for (const GrowingHull::Facet& facet : hull.slots())
    if (facet.alive)
      for (const std::uint32_t v : facet.vertices) {
        origin += position(hull.points()[v]);
        ++corners;
      }
  origin = (1 / corners) * origin;

  // Tetrahedra over the facets with the apex at an inner point: all volumes are positive.
  Vec3d moment{};
  double volume = 0;
  for (const GrowingHull::Facet& facet : hull.slots()) {
    if (!facet.alive) continue;
    const Vec3d a = position(hull.points()[facet.vertices[0]]) - origin;
    const Vec3d b = position(hull.points()[facet.vertices[1]]) - origin;
    const Vec3d c = position(hull.points()[facet.vertices[2]]) - origin;
    const double v = dot(cross(a, b), c);
    volume += v;
    moment += (v / 4) * (a + b + c);
  }
  centre_ = volume > 0 ? origin + (1 / volume) * moment : origin;
}

/// Looks for a plane for which separates(plane): tries all of a small hull; climbs to the plane
/// that cuts the ray from the centre to `middle` first on a large one. The climb is on the polar
/// dual, a convex polytope, so only facets in one plane can stop it early.
template <class Separates>
bool ShrunkHull::find_separating(Vec3d middle, Separates separates) {
  if (separates(last_)) return true;
  if (small() || thin_) {
    for (std::uint32_t p = 0; p < planes_.size(); ++p)
      if (separates(p)) {
        last_ = p;
        return true;
      }
    return false;
  }
  const Vec3d ray = middle - centre_;
  const auto score = [&](std::uint32_t p) {
    return dot(planes_[p].normal, ray) / -height(p, centre_);
  };
  std::uint32_t best = last_;
  double best_score = score(best);
  for (bool climbing = true; climbing;) {
    climbing = false;
    for (const std::uint32_t n : neighbours_[best]) {
      const double s = score(n);
      if (!(s > best_score)) continue;
      best = n;
      best_score = s;
      climbing = true;
      break;
    }
    if (separates(best)) {
      last_ = best;
      return true;
    }
  }
  last_ = best;
  return false;
}

bool ShrunkHull::surely_outside(const FaceBox& box) {
  if (!box.meets(box_)) return true;
  const Vec3d low = position(box.low);
  const Vec3d high = position(box.high);
  if (small()) return false;
  const Vec3d middle = 0.5 * (low + high);
  const Vec3d half = 0.5 * (high - low);
  return find_separating(middle, [&](std::uint32_t p) {
    const Vec3d n = planes_[p].normal;
    return height(p, middle) >
           std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
  });
}

/// Keeps what of polygon_ is not above the plane; false where nothing is left.
bool ShrunkHull::clip_away(std::uint32_t plane) {
  clipped_.clear();
  double before = height(plane, polygon_.back());
  Vec3d previous = polygon_.back();
  for (const Vec3d p : polygon_) {
    const double now = height(plane, p);
    if ((before > 0) != (now > 0))
      clipped_.push_back(previous + (before / (before - now)) * (p - previous));
    if (!(now > 0)) clipped_.push_back(p);
    before = now;
    previous = p;
  }
  polygon_.swap(clipped_);
  return !polygon_.empty();
}

bool ShrunkHull::entered_by(Vec3d a, Vec3d b, Vec3d c) {
  const auto separates = [&](std::uint32_t p) {
    return height(p, a) > 0 && height(p, b) > 0 && height(p, c) > 0;
  };
  if (find_separating((1.0 / 3) * (a + b + c), separates)) return false;
  polygon_ = {a, b, c};
  // Outward in rings from the last plane: those that cut most come first, and mostly leave nothing.
  ++visit_;
  order_.assign(1, last_);
  visited_[last_] = visit_;
  for (std::size_t next = 0; next < order_.size(); ++next) {
    const std::uint32_t p = order_[next];
    const bool cuts =
        std::any_of(polygon_.begin(), polygon_.end(), [&](Vec3d v) { return height(p, v) > 0; });
    if (cuts && !clip_away(p)) return false;
    for (const std::uint32_t n : neighbours_[p]) {
      if (visited_[n] == visit_) continue;
      visited_[n] = visit_;
      order_.push_back(n);
    }
  }
  return true;
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/shrunk_hull.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "host_bake/decompose/flat_cover.hpp"
#include "host_bake/decompose/geometry.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kSmallHull = 24;  // facets up to which trying all of them beats walking
constexpr int kCuts = 8;  // that mostly leave nothing of a triangle that does not enter

}  // namespace

bool ShrunkHull::small() const { return planes_.size() <= kSmallHull; }

void ShrunkHull::build(const GrowingHull& hull) {
  find_planes(hull);
  find_centre();
  thin_ = false;
  for (std::uint32_t p = 0; p < planes_.size(); ++p)
    if (!(height(p, centre_) < 0)) thin_ = true;
  last_ = 0;
}

void ShrunkHull::find_planes(const GrowingHull& hull) {
  const std::span<const GrowingHull::Facet> slots = hull.slots();
  planes_.clear();
  corners_.clear();
  neighbours_.clear();
  plane_of_slot_.assign(slots.size(), 0);
  box_ = FaceBox::empty();
  for (std::size_t s = 0; s < slots.size(); ++s) {
    if (!slots[s].alive) continue;
    plane_of_slot_[s] = static_cast<std::uint32_t>(planes_.size());
    const Triangle& t = slots[s].vertices;
    for (const std::uint32_t v : t) box_.add(hull.points()[v]);
    const std::array<Vec3d, 3> c = {position(hull.points()[t[0]]), position(hull.points()[t[1]]),
                                    position(hull.points()[t[2]])};
    const Vec3d n = cross(c[1] - c[0], c[2] - c[0]);
    const Vec3d normal = (1 / norm(n)) * n;
    planes_.push_back({normal, dot(normal, c[0]) - kShrink_rel});
    corners_.push_back(c);
    neighbours_.push_back(slots[s].neighbours);
  }
  for (auto& around : neighbours_)
    for (std::uint32_t& n : around) n = plane_of_slot_[n];
  visited_.assign(planes_.size(), 0);
  visit_ = 0;
}

void ShrunkHull::find_centre() {
  Vec3d origin{};
  for (const auto& c : corners_) origin += c[0] + c[1] + c[2];
  origin = (1 / (3 * static_cast<double>(corners_.size()))) * origin;

  // Tetrahedra over the facets with the apex at an inner point: all volumes are positive.
  Vec3d moment{};
  double volume = 0;
  for (const auto& corner : corners_) {
    const Vec3d a = corner[0] - origin;
    const Vec3d b = corner[1] - origin;
    const Vec3d c = corner[2] - origin;
    const double v = dot(cross(a, b), c);
    volume += v;
    moment += (v / 4) * (a + b + c);
  }
  centre_ = volume > 0 ? origin + (1 / volume) * moment : origin;
}

/// The facet next to `facet` in the direction of the point, seen from the centre; itself where the
/// ray to the point leaves through it. `turn` chooses between two ways, so that no walk goes round
/// for ever.
std::uint32_t ShrunkHull::step_toward(std::uint32_t facet, Vec3d ray, std::size_t turn) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (turn + k) % 3;
    const Vec3d a = corners_[facet][i] - centre_;
    const Vec3d b = corners_[facet][(i + 1) % 3] - centre_;
    if (dot(cross(a, b), ray) < 0) return neighbours_[facet][i];
  }
  return facet;
}

/// Looks for a plane for which separates(plane): tries all of a small hull; walks over a large one
/// to the facet between the centre and `middle`, which becomes last_.
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
  for (std::size_t step = 0; step < planes_.size(); ++step) {
    const std::uint32_t next = step_toward(last_, ray, step);
    if (next == last_) return false;
    last_ = next;
    if (separates(last_)) return true;
  }
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

/// Cuts polygon_ by the planes that lie between the centre and its middle; false where nothing is
/// left.
bool ShrunkHull::cut_toward_centre() {
  for (int cut = 0; cut < kCuts; ++cut) {
    Vec3d middle{};
    for (const Vec3d p : polygon_) middle += p;
    middle = (1 / static_cast<double>(polygon_.size())) * middle;
    const auto separates = [&](std::uint32_t plane) {
      return std::all_of(polygon_.begin(), polygon_.end(),
                         [&](Vec3d p) { return height(plane, p) > 0; });
    };
    if (find_separating(middle, separates)) return false;
    if (!(height(last_, middle) > 0)) return true;
    if (!clip_away(last_)) return false;
  }
  return true;
}

/// Cuts polygon_ by all planes, in rings about the last one; false where nothing is left.
bool ShrunkHull::cut_by_all() {
  ++visit_;
  order_.assign(1, last_);
  visited_[last_] = visit_;
  for (std::size_t next = 0; next < order_.size(); ++next) {
    const std::uint32_t plane = order_[next];
    const bool cuts = std::any_of(polygon_.begin(), polygon_.end(),
                                  [&](Vec3d p) { return height(plane, p) > 0; });
    if (cuts && !clip_away(plane)) return false;
    for (const std::uint32_t n : neighbours_[plane]) {
      if (visited_[n] == visit_) continue;
      visited_[n] = visit_;
      order_.push_back(n);
    }
  }
  return true;
}

bool ShrunkHull::holds(Vec3d p) const {
  return std::all_of(planes_.begin(), planes_.end(), [p](const Plane& plane) {
    return dot(plane.normal, p) - plane.offset <= kShrink_rel;
  });
}

bool ShrunkHull::entered_by(Vec3d a, Vec3d b, Vec3d c) {
  polygon_ = {a, b, c};
  return cut_toward_centre() && cut_by_all();
}

}  // namespace palpate::bake

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/contact/facing.hpp"
#include "rt_core/contact/found.hpp"

namespace palpate::contact {
namespace {

/// Sines between edges from which they count wholly, and up to which they are parallel.
constexpr double kParallelSine = 1e-3;
constexpr double kCrossingSine = kParallelSine + 0.05;
/// Overlaps that are no deeper are touching.
constexpr double kTouching = 1e-9;
/// An overlap of so many depths of its points counts wholly, and from so many on not at all: edges
/// sharper than 60 degrees fade, and those sharper than 30 do not count.
constexpr double kWholeOverlap = 2;
constexpr double kMostOverlap = 4;
/// What is so little beside a triangle may be on it, relative to lengths.
constexpr double kBeside = 1e-9;
/// Squares of lengths below this of the product of two edges: parallel by rounding.
constexpr double kDegenerate = 1e-6;

/// Two edges that cross, seen along their common perpendicular.
struct Crossing {
  Vec3d on_points{};
  Vec3d on_target{};
  double sine = 0;
  double to_end = 0;  ///< from the nearer of both points to the nearest end of its edge
};

bool cross_within(const Edge& p, const Edge& q, Crossing& out) noexcept {
  const Vec3d along_p = p.to - p.from;
  const Vec3d along_q = q.to - q.from;
  const Vec3d between = p.from - q.from;
  const double pp = squared_norm(along_p);
  const double qq = squared_norm(along_q);
  const double pq = dot(along_p, along_q);
  const double determinant = pp * qq - pq * pq;
  if (determinant < kDegenerate * pp * qq) return false;
  const double p_between = dot(along_p, between);
  const double q_between = dot(along_q, between);
  const double s = (pq * q_between - p_between * qq) / determinant;
  const double t = (pp * q_between - pq * p_between) / determinant;
  if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return false;
  out.on_points = p.from + s * along_p;
  out.on_target = q.from + t * along_q;
  out.sine = sqrt_of(determinant / (pp * qq));
  const double end_p = (s < 1 - s ? s : 1 - s) * sqrt_of(pp);
  const double end_q = (t < 1 - t ? t : 1 - t) * sqrt_of(qq);
  out.to_end = end_p < end_q ? end_p : end_q;
  return true;
}

Edge moved(const Side& side, const Edge& edge) noexcept {
  Edge out = edge;
  out.from = side.to_target(edge.from);
  out.to = side.to_target(edge.to);
  out.normal = side.turned_to_target(edge.normal);
  out.other_normal = side.turned_to_target(edge.other_normal);
  return out;
}

class EdgeContacts {
 public:
  EdgeContacts(const Side& side, const Target& points, Pace& pace, const Edge& edge,
               const EdgeEnds& ends, double delta, FoundContacts& out) noexcept
      : side_(side),
        points_(points),
        pace_(pace),
        edge_(moved(side, edge)),
        delta_(delta),
        reach_(kReach * delta),
        ends_(ends),
        out_(out) {
    const bool open = is_open(side.target.surface);  // its inside begins anywhere
    if (open || ends.from <= 0) widen(0);
    if (open || ends.to <= 0) widen(1);
  }

  /// What is apart first. Where something of the edge is inside it pierces the surface, and only
  /// then it may cross others in overlap: no deeper than what lies between the first and the last
  /// place.
  void run() noexcept {
    see_near(reach_);
    const double deepest = inside_to_ < inside_from_ ? 0 : deepest_inside();
    if (!(deepest > 0)) return;
    overlapping_ = true;
    see_near(kMostOverlap * deepest);
  }

 private:
  void see_near(double farthest) noexcept {
    farthest_ = farthest;
    const double radius = farthest * kRoomForRounding;
    const Surface& target = side_.target.surface;
    for_each_near_segment(
        side_.target, pace_, edge_.from, edge_.to, radius, [&](std::uint32_t triangle) {
          const image::RegionTriangle& t = target.image->region_triangles[triangle];
          if (!overlapping_) note_piercing(target, triangle);
          for (std::uint32_t i = 0; i < 3; ++i) {
            // Each edge once, with the first of its triangles: it may be met with that one's box
            // only.
            if (t.neighbours[i] == image::kNone || t.neighbours[i] < triangle) continue;
            see(target, 3 * triangle + i);
          }
        });
  }

  /// Widens the part of the edge that may be inside. Rather too far than not far enough: what is
  /// beside a triangle by rounding, or lies in its plane, counts.
  void note_piercing(const Surface& target, std::uint32_t triangle) noexcept {
    const Vec3d a = corner(target, triangle, 0);
    const Vec3d ab = corner(target, triangle, 1) - a;
    const Vec3d ac = corner(target, triangle, 2) - a;
    const Vec3d normal = cross(ab, ac);
    const double from = dot(normal, edge_.from - a);
    const double to = dot(normal, edge_.to - a);
    const double size = norm(normal);
    const double rounding = kBeside * size * (norm(ab) + norm(ac) + norm(edge_.to - edge_.from));
    if ((from > rounding && to > rounding) || (from < -rounding && to < -rounding)) return;
    if (from - to <= 2 * rounding && to - from <= 2 * rounding) {
      widen(0);
      widen(1);
      return;
    }
    const double t = clamp01(from / (from - to));
    const Vec3d x = edge_.from + t * (edge_.to - edge_.from) - a;
    const double along_b = dot(cross(x, ac), normal);
    const double along_c = dot(cross(ab, x), normal);
    const double room = kBeside * size * size + rounding * size;
    if (along_b < -room || along_c < -room || along_b + along_c > size * size + room) return;
    widen(t);
  }

  void widen(double t) noexcept {
    inside_from_ = t < inside_from_ ? t : inside_from_;
    inside_to_ = t > inside_to_ ? t : inside_to_;
  }

  /// Signed distances change no faster than points move, and are zero where the surface is pierced.
  double deepest_inside() const noexcept {
    const double length = (inside_to_ - inside_from_) * norm(edge_.to - edge_.from);
    const double from = inside_from_ > 0 ? 0 : ends_.from;
    const double to = inside_to_ < 1 ? 0 : ends_.to;
    return 0.5 * (length - from - to);
  }

  void see(const Surface& target, std::uint32_t name) noexcept {
    Edge other;
    other.from = corner(target, name / 3, name % 3);
    other.to = corner(target, name / 3, (name % 3 + 1) % 3);
    Crossing at;
    if (!cross_within(edge_, other, at)) return;
    other = edge_of(target, name);
    if (!other.convex) return;
    Vec3d normal = cross(edge_.to - edge_.from, other.to - other.from);
    normal = (1 / norm(normal)) * normal;
    if (dot(normal, other.normal + other.other_normal) < 0) normal = -normal;
    if (dot(normal, edge_.normal + edge_.other_normal) >= 0) return;
    const double distance = dot(normal, at.on_points - at.on_target);
    if ((distance < -kTouching) != overlapping_) return;
    if (distance > reach_ || -distance > farthest_) return;
    double weight = facing(nearest_on_arc(-normal, edge_.normal, edge_.other_normal).cosine) *
                    facing(nearest_on_arc(normal, other.normal, other.other_normal).cosine) *
                    within_reach(distance, delta_) *
                    clamp01((at.sine - kParallelSine) / (kCrossingSine - kParallelSine));
    if (weight > 0 && overlapping_) weight *= overlap_weight(at, other, -distance);
    if (weight > 0) {
      out_.add({normal, distance, weight, at.on_points, at.on_target, name / 3});
    }
  }

  /// Fades at the edges' ends, and where either point is not inside the other body or has a shorter
  /// way out that both surfaces face.
  double overlap_weight(const Crossing& at, const Edge& other, double depth) noexcept {
    double weight = clamp01(at.to_end / depth);
    const auto in_target = [&](Vec3d way) {
      return nearest_on_arc(-way, edge_.normal, edge_.other_normal).cosine;
    };
    const auto in_points = [&](Vec3d way) {
      const Vec3d turned = side_.turned_to_target(way);
      return nearest_on_arc(-turned, other.normal, other.other_normal).cosine;
    };
    if (weight > 0) weight *= inside(side_.target, at.on_points, depth, in_target);
    if (weight > 0) weight *= inside(points_, side_.to_points(at.on_target), depth, in_points);
    return weight;
  }

  /// @param faces  the cosine between a way out and what the point's own edge faces
  template <class Faces>
  double inside(const Target& target, Vec3d x, double depth, Faces faces) noexcept {
    const double value = signed_distance(target, pace_, x, image::kNone).value;
    if (!(value < 0)) return 0;
    const double weight = clamp01((kMostOverlap + depth / value) / (kMostOverlap - kWholeOverlap));
    if (!(weight > 0)) return 0;
    double shortest = kAnywhere;
    const double radius = depth;
    for_each_near(target, pace_, x, radius, [&](std::uint32_t triangle) {
      const Foot foot = closest_point(target.surface, triangle, x);
      const double length = sqrt_of(foot.squared);
      if (!(length > 0) || length > depth) return;
      const Vec3d way = (1 / length) * (foot.point - x);
      if (dot(way, pseudonormal(target.surface, foot)) <= 0) return;
      const double both = facing(nearest_at(target.surface, foot, way).cosine) * facing(faces(way));
      if (both > 0 && length / both < shortest) shortest = length / both;
    });
    return weight * directness(shortest, depth) * solidity(target.surface, -value);
  }

  const Side& side_;
  const Target& points_;
  Pace& pace_;
  Edge edge_;
  double delta_;
  double reach_;
  double farthest_ = 0;
  bool overlapping_ = false;  // crossings in overlap are seen, otherwise those apart
  EdgeEnds ends_;
  double inside_from_ = 1;  // the part of the edge that may be inside; none where to < from
  double inside_to_ = 0;
  FoundContacts& out_;
};

}  // namespace

void contacts_of_edge(const Side& side, const Target& points, Pace& pace, std::uint32_t edge,
                      const EdgeEnds& ends, double delta, Scratch& scratch) noexcept {
  scratch.found.clear();
  const Edge own = edge_of(side.points, edge);
  if (own.convex) EdgeContacts(side, points, pace, own, ends, delta, scratch.found).run();
}

}  // namespace palpate::contact

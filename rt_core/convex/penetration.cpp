// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/penetration.hpp"

#include <limits>

#include "rt_core/base/assert.hpp"
#include "rt_core/convex/simplex.hpp"

namespace palpate::convex {
namespace {

/// Of the extent of a - b.
constexpr double kCoplanar = 1e-13;
/// Cosine between normals of faces that lie in one plane.
constexpr double kOnePlane = 1 - 1e-9;

/// The narrowest extent of a - b beyond the origin seen so far, and the face it was seen through.
struct Best {
  double extent = std::numeric_limits<double>::infinity();
  Vec3d outward{};
  DifferencePoint corners[3];
};

Vec3d unit(Vec3d v) noexcept { return (1 / norm(v)) * v; }

/// What spans a - b: up to four of its points, and a unit direction across them where fewer do.
struct Span {
  DifferencePoint corners[4];
  std::uint32_t count = 1;
  Vec3d flat_normal{1, 0, 0};
};

/// Of the support points along a direction and against it, keeps what beats the best measure of
/// the way from `from`.
template <class Measure>
void keep_farthest(const HullPair& pair, Vec3d direction, const DifferencePoint& from,
                   const Measure& measure, DifferencePoint& best, double& best_measure) noexcept {
  const Vec3d both[2] = {direction, -direction};
  for (const Vec3d& d : both) {
    const DifferencePoint w = support(pair, d, from);
    const double m = measure(w.point - from.point);
    if (m > best_measure) {
      best_measure = m;
      best = w;
    }
  }
}

/// Finds well-spread corners from nothing.
Span span(const HullPair& pair) noexcept {
  const double flat2 = kTouching * kTouching * extent(pair) * extent(pair);
  Span s;
  s.corners[0] = difference(pair, 0, 0);
  const DifferencePoint& origin = s.corners[0];
  double far2 = flat2;
  const auto length2 = [](Vec3d v) { return squared_norm(v); };
  const Vec3d axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vec3d& axis : axes) {
    keep_farthest(pair, axis, origin, length2, s.corners[1], far2);
  }
  if (!(far2 > flat2)) return s;
  s.count = 2;
  const Vec3d line = unit(s.corners[1].point - origin.point);
  s.flat_normal = across(line);
  far2 = flat2;
  const auto off_line2 = [line](Vec3d v) { return squared_norm(v - dot(v, line) * line); };
  keep_farthest(pair, s.flat_normal, origin, off_line2, s.corners[2], far2);
  keep_farthest(pair, cross(line, s.flat_normal), origin, off_line2, s.corners[2], far2);
  if (!(far2 > flat2)) return s;
  s.count = 3;
  s.flat_normal = unit(cross(line, s.corners[2].point - origin.point));
  far2 = flat2;
  const Vec3d normal = s.flat_normal;
  const auto off_plane2 = [normal](Vec3d v) { return dot(v, normal) * dot(v, normal); };
  keep_farthest(pair, normal, origin, off_plane2, s.corners[3], far2);
  if (far2 > flat2) s.count = 4;
  return s;
}

/// The corners of the cache where they are a tetrahedron of some volume, else well-spread ones.
Span corners_to_start(const HullPair& pair, const Cache& cache) noexcept {
  constexpr double kMinVolume2 = 1e-8;
  if (cache.count == 4) {
    Span s;
    s.count = 4;
    for (std::uint32_t i = 0; i < 4; ++i) {
      PALPATE_ASSERT(cache.a[i] < pair.a.count && cache.b[i] < pair.b.count);
      s.corners[i] = difference(pair, cache.a[i], cache.b[i]);
    }
    const Vec3d u = s.corners[1].point - s.corners[0].point;
    const Vec3d v = s.corners[2].point - s.corners[0].point;
    const Vec3d w = s.corners[3].point - s.corners[0].point;
    const double volume = dot(u, cross(v, w));
    const double size2 = squared_norm(u) * squared_norm(v) * squared_norm(w);
    if (volume * volume > kMinVolume2 * size2) return s;
  }
  return span(pair);
}

void keep(Best& best, double extent, Vec3d outward, const DifferencePoint (&corners)[3]) noexcept {
  best.extent = extent;
  best.outward = outward;
  for (std::uint32_t i = 0; i < 3; ++i) best.corners[i] = corners[i];
}

/// Grows the polytope until its nearest face is one of a - b. The proved lower bound of the depth.
/// out_settled is false where something else ended it: the polytope must then not be used any more.
double expand(const HullPair& pair, Polytope& polytope, Best& best, bool& out_settled) noexcept {
  double lower = 0;
  out_settled = false;
  for (std::uint32_t i = 0; i < kMaxPolytopeVertices; ++i) {  // each turn adds a vertex
    const std::uint32_t lowest = lowest_face(polytope);
    const PolytopeFace& face = polytope.faces[lowest];
    if (face.offset > lower) lower = face.offset;
    const DifferencePoint corners[3] = {polytope.vertices[face.vertices[0]],
                                        polytope.vertices[face.vertices[1]],
                                        polytope.vertices[face.vertices[2]]};
    const DifferencePoint w = support(pair, face.normal, corners[0]);
    const double e = dot(face.normal, w.point);
    // A face of a - b itself is kept over an equal direction seen before: its normal is the exact
    // one.
    const bool settled = e - face.offset <= kDistanceGap * extent(pair);
    if (settled || e < best.extent) keep(best, e, face.normal, corners);
    out_settled = settled;
    if (settled || !add_vertex(polytope, lowest, w, kCoplanar * extent(pair))) break;
  }
  return lower;
}

/// Squared distance of a triangle, not of its plane, from the origin.
double squared_way(const DifferencePoint& p, const DifferencePoint& q,
                   const DifferencePoint& r) noexcept {
  const Vec3d points[3] = {p.point, q.point, r.point};
  return nearest_on_triangle(points, 0, 1, 2).squared;
}

/// Of triangles in one plane, the one that the origin projects into: its corners are the deepest
/// points.
class Deepest {
 public:
  void add(const DifferencePoint& p, const DifferencePoint& q, const DifferencePoint& r,
           Best& best) noexcept {
    const double away2 = squared_way(p, q, r);
    if (away2 >= least_) return;
    least_ = away2;
    best.corners[0] = p;
    best.corners[1] = q;
    best.corners[2] = r;
  }

 private:
  double least_ = std::numeric_limits<double>::infinity();
};

/// Of the faces that are equally low.
void keep_deepest(const HullPair& pair, const Polytope& polytope, Best& best) noexcept {
  const double low = best.extent + kDistanceGap * extent(pair);
  Deepest deepest;
  for (std::uint32_t f = 0; f < polytope.face_count; ++f) {
    const PolytopeFace& face = polytope.faces[f];
    if (!face.live || face.offset > low || dot(face.normal, best.outward) < kOnePlane) continue;
    deepest.add(polytope.vertices[face.vertices[0]], polytope.vertices[face.vertices[1]],
                polytope.vertices[face.vertices[2]], best);
  }
}

/// Of the simplex that distance() ended with: it lies in the plane where a - b does.
void keep_deepest(const HullPair& pair, const Cache& cache, Best& best) noexcept {
  if (cache.count == 0) return;
  DifferencePoint corners[4];
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t k = i < cache.count ? i : cache.count - 1;
    PALPATE_ASSERT(cache.a[k] < pair.a.count && cache.b[k] < pair.b.count);
    corners[i] = difference(pair, cache.a[k], cache.b[k]);
  }
  Deepest deepest;
  for (std::uint32_t i = 0; i < 4; ++i)
    deepest.add(corners[i], corners[(i + 1) % 4], corners[(i + 2) % 4], best);
}

/// The narrower of the two sides of what is flat, straight or a point.
void measure_flat(const HullPair& pair, const Span& s, Best& best) noexcept {
  const DifferencePoint corners[3] = {s.corners[0], s.count > 1 ? s.corners[1] : s.corners[0],
                                      s.count > 2 ? s.corners[2] : s.corners[0]};
  const Vec3d sides[2] = {s.flat_normal, -s.flat_normal};
  for (const Vec3d& side : sides) {
    const double e = dot(side, support(pair, side, corners[0]).point);
    if (e < best.extent) keep(best, e, side, corners);
  }
}

/// The point of a that combines like the point of the best face nearest the origin.
Vec3d witness_a(const HullPair& pair, const Best& best) noexcept {
  const Vec3d points[3] = {best.corners[0].point, best.corners[1].point, best.corners[2].point};
  const Nearest nearest = nearest_on_triangle(points, 0, 1, 2);
  Vec3d p{};
  for (std::uint32_t i = 0; i < nearest.count; ++i) {
    p += nearest.weight[i] * vertex_of_a(pair, best.corners[nearest.index[i]].a);
  }
  return p;
}

}  // namespace

Penetration penetration(const Hull& a, const Hull& b, const RelativePose& b_in_a,
                        const Cache& cache, PenetrationScratch& scratch) noexcept {
  const HullPair pair{a, b, b_in_a};
  const Span s = corners_to_start(pair, cache);
  Best best;
  double lower = 0;
  if (s.count == 4 && start(scratch.polytope, s.corners)) {
    bool settled = false;
    lower = expand(pair, scratch.polytope, best, settled) - rounding(pair);
    if (settled) keep_deepest(pair, scratch.polytope, best);
  } else {
    measure_flat(pair, s, best);
    keep_deepest(pair, cache, best);
  }
  Penetration out;
  out.depth = best.extent > 0 ? best.extent : 0;
  out.lower_bound = lower > 0 ? (lower < out.depth ? lower : out.depth) : 0;
  out.normal = -best.outward;
  out.point_a = witness_a(pair, best);
  out.point_b = out.point_a + out.depth * out.normal;
  out.exact = out.depth - out.lower_bound <= kDistanceAccept * extent(pair);
  return out;
}

}  // namespace palpate::convex

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/pressure.hpp"

#include <limits>

namespace palpate::convex {
namespace {

using Corner = PressureScratch::Corner;
using Facet = PressureScratch::Facet;
using Polygon = PressureScratch::Polygon;
using Set = PressureScratch::Set;
using Side = PressureScratch::Side;

/// Faces of up to one slope carry, those from the other one on do not: what of them is within reach
/// is narrow.
constexpr double kCarries = 0.25;
constexpr double kWall = 0.5;
/// Share of the reach within which all faces are looked at: from less the centre counts less, so
/// that it is the closest points' where too many faces meet there.
constexpr double kEnough = 0.02;
// In units.
/// Vertices no farther above a plane are in it: baked ones are rounded to 6e-8.
constexpr double kInPlane = 1e-6;
/// Points no farther beside an edge are on it.
constexpr double kOnEdge = 1e-9;

double cross(const Corner& from, const Corner& p, const Corner& q) noexcept {
  return (p.x - from.x) * (q.y - from.y) - (p.y - from.y) * (q.x - from.x);
}

double squared_distance(const Corner& p, const Corner& q) noexcept {
  return (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
}

/// How a hull's coordinates are seen: along its way to the other one, from the middle.
struct View {
  Vec3d u;
  Vec3d v;
  Vec3d up;  ///< away from the other
  Vec3d from;

  Corner of(Vec3d p) const noexcept { return {dot(p, u) - from.x, dot(p, v) - from.y, dot(p, up)}; }
};

/// Vertices of faces that carry: seen from the lowest one, which comes first at height 0, they rise
/// no more steeply than such faces do.
void look(const Hull& hull, const View& view, Side& out) noexcept {
  auto& vertices = out.vertices;
  vertices.count = 0;
  std::uint32_t lowest = 0;
  for (std::uint32_t i = 0; i < hull.count; ++i) {
    vertices.add(view.of(hull.scale * position(hull, i)));
    if (vertices.at[i].height < vertices.at[lowest].height) lowest = i;
  }
  const Corner first = vertices.at[lowest];
  vertices.at[lowest] = vertices.at[0];
  vertices.at[0] = {first.x, first.y, 0};
  const std::uint32_t all = vertices.count;
  vertices.count = 1;
  for (std::uint32_t i = 1; i < all; ++i) {
    const Corner& c = vertices.at[i];
    const double rise = c.height - first.height - kInPlane;
    if (rise <= 0 || rise * rise <= kWall * kWall * squared_distance(first, c))
      vertices.add({c.x, c.y, c.height - first.height});
  }
}

/// The least slope from the lowest vertex to another one. The line between the two lies on the
/// lower side of the hull.
struct Gentlest {
  std::uint32_t vertex = 0;
  double squared_slope = std::numeric_limits<double>::infinity();
};

Gentlest gentlest(const Side& side) noexcept {
  Gentlest out;
  for (std::uint32_t i = 1; i < side.vertices.count; ++i) {
    const Corner& c = side.vertices.at[i];
    const double rise2 = c.height * c.height;
    const double away2 = squared_distance(side.vertices.at[0], c);
    if (rise2 < out.squared_slope * away2) out = {i, rise2 / away2};
  }
  return out;
}

/// 1 up to one slope, 0 from another one on.
double fading(double squared_slope, double from, double to) noexcept {
  if (squared_slope <= from * from) return 1;
  return squared_slope < to * to ? (to - sqrt_of(squared_slope)) / (to - from) : 0;
}

/// How far a hull is flat or has a level edge at its lowest vertex.
double flatness(const Gentlest& gentlest) noexcept {
  return fading(gentlest.squared_slope, 0.04, 0.1);
}

double carried_by(const Facet& facet) noexcept {
  const double squared_slope = facet.slope_x * facet.slope_x + facet.slope_y * facet.slope_y;
  return fading(squared_slope, kCarries, kWall);
}

double height_of(const Facet& facet, const Corner& c) noexcept {
  return facet.at_0 + facet.slope_x * c.x + facet.slope_y * c.y;
}

/// The face of the hull's lower side to the right of the way from one vertex to another, an edge of
/// it: the least steep plane through both and a third one there.
struct Turn {
  bool found = false;  ///< or there is none but walls
  std::uint32_t third = 0;
  double slope_x = 0;
  double slope_y = 0;
};

Turn turn_about(const Side& side, std::uint32_t from, std::uint32_t to) noexcept {
  Turn out;
  const Corner& p = side.vertices.at[from];
  const Corner& q = side.vertices.at[to];
  const double length = sqrt_of(squared_distance(p, q));
  if (!(length > kOnEdge)) return out;
  const double along_x = (q.x - p.x) / length;
  const double along_y = (q.y - p.y) / length;
  const double along = (q.height - p.height) / length;
  double across = kWall;
  for (std::uint32_t i = 0; i < side.vertices.count; ++i) {
    const Corner& c = side.vertices.at[i];
    const double x = c.x - p.x;
    const double y = c.y - p.y;
    const double beside = x * along_y - y * along_x;
    if (!(beside > kOnEdge)) continue;
    const double rise = c.height - p.height - along * (x * along_x + y * along_y);
    if (!(rise < across * beside)) continue;
    across = rise / beside;
    out.found = true;
    out.third = i;
  }
  out.slope_x = along * along_x + across * along_y;
  out.slope_y = along * along_y - across * along_x;
  return out;
}

void gather_members(const Side& side, Facet& facet) noexcept {
  facet.members.clear();
  for (std::uint32_t i = 0; i < side.vertices.count; ++i) {
    const Corner& c = side.vertices.at[i];
    if (c.height - height_of(facet, c) <= kInPlane) facet.members.add(i);
  }
}

/// Puts a member at the end of a chain that begins at `first`, and takes away what is not to the
/// right of the way to it.
void extend(const Side& side, Facet& facet, std::uint32_t first, std::uint8_t member) noexcept {
  const auto at = [&](std::uint8_t vertex) { return side.vertices.at[vertex]; };
  const std::uint8_t* const outline = facet.outline;
  while (facet.count >= first + 2 &&
         !(cross(at(outline[facet.count - 2]), at(outline[facet.count - 1]), at(member)) > 0)) {
    --facet.count;
  }
  facet.outline[facet.count++] = member;
}

/// The convex hull of the members (Andrew 1979). False where they are on one line.
bool draw_outline(const Side& side, Facet& facet) noexcept {
  std::uint8_t sorted[kMostCarrying];
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < side.vertices.count; ++i) {
    if (!facet.members.has(i)) continue;
    std::uint32_t hole = count++;
    const Corner& c = side.vertices.at[i];
    for (; hole > 0; --hole) {
      const Corner& before = side.vertices.at[sorted[hole - 1]];
      if (before.x < c.x || (before.x == c.x && before.y <= c.y)) break;
      sorted[hole] = sorted[hole - 1];
    }
    sorted[hole] = static_cast<std::uint8_t>(i);
  }
  facet.known_beyond.clear();
  facet.count = 0;
  for (std::uint32_t i = 0; i < count; ++i) extend(side, facet, 0, sorted[i]);
  const std::uint32_t last = facet.count - 1;
  for (std::uint32_t i = count - 1; i-- > 0;) extend(side, facet, last, sorted[i]);
  --facet.count;  // back at the first
  return facet.count >= 3;
}

bool have_three_in_common(const Set& a, const Set& b) noexcept {
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < kMostCarrying / 32; ++k) {
    for (std::uint32_t common = a.words[k] & b.words[k]; common != 0; common &= common - 1) {
      if (++count == 3) return true;
    }
  }
  return false;
}

/// Enters the face to the right of the way from one vertex to another, unless there is none but
/// walls. Two faces have no more than an edge in common: with more they are one, hardly bent.
void enter_facet(Side& side, std::uint32_t from, std::uint32_t to) noexcept {
  const Turn turn = turn_about(side, from, to);
  if (!turn.found) return;
  for (std::uint32_t i = 0; i < side.facet_count; ++i) {
    const Set& known = side.facets[i].members;
    if (known.has(from) && known.has(to) && known.has(turn.third)) return;
  }
  Facet& facet = side.facets[side.facet_count];
  const Corner& p = side.vertices.at[from];
  facet.slope_x = turn.slope_x;
  facet.slope_y = turn.slope_y;
  facet.at_0 = p.height - facet.slope_x * p.x - facet.slope_y * p.y;
  gather_members(side, facet);
  for (std::uint32_t i = 0; i < side.facet_count; ++i) {
    Facet& known = side.facets[i];
    if (!have_three_in_common(known.members, facet.members)) continue;
    known.members.add(facet.members);
    static_cast<void>(draw_outline(side, known));
    return;
  }
  if (draw_outline(side, facet)) ++side.facet_count;
}

/// An edge of a face.
struct Edge {
  std::uint32_t facet = 0;
  std::uint32_t corner = 0;
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  double height = 0;  ///< of its lower end
};

/// The lowest edge below the reach beyond which nothing is known. False where there is none.
bool find_edge(const Side& side, double reach, Edge& out) noexcept {
  out.height = reach;
  for (std::uint32_t i = 0; i < side.facet_count; ++i) {
    const Facet& facet = side.facets[i];
    for (std::uint32_t k = 0; k < facet.count; ++k) {
      if (facet.known_beyond.has(k)) continue;
      const std::uint32_t from = facet.outline[k];
      const std::uint32_t to = facet.outline[k + 1 < facet.count ? k + 1 : 0];
      const double from_height = side.vertices.at[from].height;
      const double to_height = side.vertices.at[to].height;
      const double height = from_height < to_height ? from_height : to_height;
      if (height < out.height) out = {i, k, from, to, height};
    }
  }
  return out.height < reach;
}

/// Is the face beyond it known?
bool is_shared(const Side& side, const Edge& edge) noexcept {
  for (std::uint32_t i = 0; i < side.facet_count; ++i) {
    const Set& members = side.facets[i].members;
    if (i != edge.facet && members.has(edge.from) && members.has(edge.to)) return true;
  }
  return false;
}

/// Faces that come below the reach, the lowest first, from edge to edge. Up to how high all are
/// there.
double find_facets(Side& side, std::uint32_t gentlest, double reach) noexcept {
  side.facet_count = 0;
  enter_facet(side, 0, gentlest);
  enter_facet(side, gentlest, 0);
  Edge edge;
  for (std::uint32_t turn = 0; turn < kMostEdges; ++turn) {
    if (!find_edge(side, reach, edge)) return reach;
    side.facets[edge.facet].known_beyond.add(edge.corner);
    if (is_shared(side, edge)) continue;
    enter_facet(side, edge.from, edge.to);
    if (side.facet_count > kMostFacets) {
      --side.facet_count;
      break;
    }
  }
  return edge.height;
}

/// Keeps what is on the side of a line where on_side() is not negative.
template <class OnSide>
void clip(Polygon& polygon, const OnSide& on_side, Polygon& kept) noexcept {
  kept.count = 0;
  for (std::uint32_t i = 0; i < polygon.count; ++i) {
    const Corner& p = polygon.at[i];
    const Corner& q = polygon.at[i + 1 < polygon.count ? i + 1 : 0];
    const double at_p = on_side(p);
    const double at_q = on_side(q);
    if (at_p >= 0) kept.add(p);
    if ((at_p >= 0) == (at_q >= 0)) continue;
    const double t = at_p / (at_p - at_q);
    kept.add({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), 0});
  }
  polygon.count = 0;
  for (std::uint32_t i = 0; i < kept.count; ++i) polygon.add(kept.at[i]);
}

/// Integrals over faces.
struct Pressure {
  double all = 0;
  double moment_x = 0;
  double moment_y = 0;

  /// What left() leaves, which is linear, over a polygon; times 24.
  template <class Left>
  void add(const Polygon& polygon, double share, const Left& left) noexcept {
    for (std::uint32_t i = 1; i + 1 < polygon.count; ++i) {
      const Corner* const corners[3] = {&polygon.at[0], &polygon.at[i], &polygon.at[i + 1]};
      const double area2 = share * cross(*corners[0], *corners[1], *corners[2]);
      const double sum = left(*corners[0]) + left(*corners[1]) + left(*corners[2]);
      all += 4 * area2 * sum;
      for (const Corner* c : corners) {
        moment_x += area2 * (sum + left(*c)) * c->x;
        moment_y += area2 * (sum + left(*c)) * c->y;
      }
    }
  }
};

void add_pair(PressureScratch& s, const Facet& a, const Facet& b, double reach,
              Pressure& pressure) noexcept {
  const double share = carried_by(a) * carried_by(b);
  if (!(share > 0)) return;
  s.common.count = 0;
  for (std::uint32_t i = 0; i < a.count; ++i) s.common.add(s.a.vertices.at[a.outline[i]]);
  for (std::uint32_t i = 0; i < b.count && s.common.count > 0; ++i) {
    const Corner& p = s.b.vertices.at[b.outline[i]];
    const Corner& q = s.b.vertices.at[b.outline[i + 1 < b.count ? i + 1 : 0]];
    clip(
        s.common, [&](const Corner& c) { return cross(p, q, c); }, s.kept);
  }
  const auto left = [&](const Corner& c) { return reach - height_of(a, c) - height_of(b, c); };
  clip(s.common, left, s.kept);
  pressure.add(s.common, share, left);
}

}  // namespace

PressureCentre centre_of_pressure(const HullPair& pair, Vec3d normal, double reach, Vec3d middle,
                                  PressureScratch& scratch) noexcept {
  if (pair.a.count > kMostCarrying || pair.b.count > kMostCarrying || !(reach > 0)) return {};
  const Vec3d u = across(normal);
  const Vec3d v = palpate::cross(normal, u);
  look(pair.a, {u, v, normal, {dot(middle, u), dot(middle, v), 0}}, scratch.a);
  const Gentlest of_a = gentlest(scratch.a);
  const double flat_a = flatness(of_a);
  if (!(flat_a > 0)) return {};
  const Mat3d to_b = transpose(pair.b_in_a.rotation);
  const Vec3d off = middle - pair.b_in_a.translation;
  look(pair.b, {to_b * u, to_b * v, -(to_b * normal), {dot(off, u), dot(off, v), 0}}, scratch.b);
  const Gentlest of_b = gentlest(scratch.b);
  const double flat_b = flatness(of_b);
  if (!(flat_b > 0)) return {};

  const double all = reach;
  reach = find_facets(scratch.a, of_a.vertex, reach);
  reach = find_facets(scratch.b, of_b.vertex, reach);
  Pressure pressure;
  for (std::uint32_t i = 0; i < scratch.a.facet_count; ++i) {
    for (std::uint32_t k = 0; k < scratch.b.facet_count; ++k)
      add_pair(scratch, scratch.a.facets[i], scratch.b.facets[k], reach, pressure);
  }
  if (!(pressure.all > std::numeric_limits<double>::min())) return {};
  const double across_u = pressure.moment_x / pressure.all;
  const double across_v = pressure.moment_y / pressure.all;
  const double flat = flat_a < flat_b ? flat_a : flat_b;
  const double looked_at = reach / (kEnough * all);
  return {middle + across_u * u + across_v * v, looked_at < 1 ? looked_at * flat : flat};
}

}  // namespace palpate::convex

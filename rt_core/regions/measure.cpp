// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/measure.hpp"

#include "rt_core/contact/facing.hpp"
#include "rt_core/contact/nearby.hpp"
#include "rt_core/regions/explained.hpp"

namespace palpate::regions {
namespace {

/// Strengths within this of what is explained, in delta, change nothing that is felt.
constexpr double kNegligible = 1e-9;
/// A region's centre is measured where that may raise its bound by so many delta: by more than
/// rounding, so that it ends.
constexpr double kWorthTightening = 0.1;
/// Vertices and edges that are passed over by their bounds.
constexpr std::uint32_t kPassedOverPerUnit = 8;

double larger(double a, double b) noexcept { return a > b ? a : b; }
double smaller(double a, double b) noexcept { return a < b ? a : b; }

}  // namespace

double Explanation::strength_of_distance(double lower_m) const noexcept {
  // Ways out of overlap are at most kMostDetour depths long.
  return lower_m >= 0 ? delta_m - lower_m : delta_m - contact::kMostDetour * lower_m;
}

bool Explanation::is_open(double excess) const noexcept {
  return excess > negligible_m + kNegligible * delta_m;
}

double Explanation::explained_m(const SideView& view, Vec3d axis, double cosine) const noexcept {
  const Vec3d push_axis = cosine > -1 ? view.push_axis(axis) : Vec3d{};
  const double by_push = explained({push, share, strongest_m}, push_axis, cosine);
  // What is stronger than the strongest makes fading contacts weaker.
  return share < 1 ? by_push : smaller(by_push, strongest_m);
}

double Explanation::explained_m(const SideView& view, std::uint32_t region) const noexcept {
  const image::SurfaceRun& r = view.image().surface_runs[region];
  return explained_m(view, vec3d(r.normal), static_cast<double>(r.normal_cos));
}

double Explanation::excess_m(const SideView& view, double explained_m,
                             double lower) const noexcept {
  const double lower_m = lower * view.unit_m;
  if (lower_m > contact::kReach * delta_m) return -kUnknown;
  return strength_of_distance(lower_m) - explained_m;
}

void Measuring::source(const ContactSource& source) noexcept {
  if (source.is_edge()) {
    edge(source.side, source.index());
  } else {
    vertex(source.side, source.index());
  }
}

void Measuring::region(NearRegion& item) noexcept {
  if (tighten(item)) return;
  const SideView& view = memory_.views[item.side];
  const image::SurfaceRun run = view.image().surface_runs[item.region];
  Visit visit;
  visit.explained_m = explanation_.explained_m(view, item.region);
  RegionBound& bound = memory_.sides[item.side].regions[item.region];
  visit.lower = bound.lower_until - view.odometer;
  pace_->charge((run.vertices + run.edges) / kPassedOverPerUnit);
  for (std::uint32_t i = 0; i < run.vertices; ++i) visit_vertex(item, run.first_vertex + i, visit);
  for (std::uint32_t i = 0; i < run.edges; ++i) visit_edge(item, run.first_edge + i, visit);
  if (visit.least < kUnknown) {
    bound.lower_until = larger(bound.lower_until, visit.least + view.odometer);
  }
  item.lower = visit.unmeasured;
  if (!visit.open) item.settled = explanation_.version;
}

/// Whether something of a region is open, and is to be measured now.
bool Measuring::measures(const SideView& view, const contact::NormalCone& cone, double lower,
                         Visit& visit) noexcept {
  const double explained_m = explanation_.explained_m(view, cone.axis, cone.cosine);
  if (!explanation_.is_open(explanation_.excess_m(view, explained_m, lower))) return false;
  visit.open = true;
  return pace_->go_on_for(memory_.measure_ns);
}

void Measuring::visit_vertex(const NearRegion& item, std::uint32_t index, Visit& visit) noexcept {
  const SideView& view = memory_.views[item.side];
  VertexBound& at = memory_.sides[item.side].vertices[index];
  const bool measured = at.measured_tick == memory_.tick;
  double lower = larger(at.lower_until - view.odometer, measured ? visit.lower : item.lower);
  if (!measured && explanation_.is_open(explanation_.excess_m(view, visit.explained_m, lower)) &&
      measures(view, contact::cone_of_vertex(view.side.points, index), lower, visit)) {
    vertex(item.side, index);
  }
  lower = larger(at.lower_until - view.odometer, lower);
  if (at.measured_tick != memory_.tick) visit.unmeasured = smaller(visit.unmeasured, lower);
  visit.least = smaller(visit.least, lower);
}

void Measuring::visit_edge(const NearRegion& item, std::uint32_t index, Visit& visit) noexcept {
  const SideView& view = memory_.views[item.side];
  const bool measured = memory_.sides[item.side].edge_ticks[index] == memory_.tick;
  const double lower = edge_bound({item.side, index}, measured ? visit.lower : item.lower);
  visit.least = smaller(visit.least, lower);
  if (measured) return;
  const auto cone = [&] {
    const std::uint32_t name = view.image().surface_edges[index];
    return contact::cone_of_edge(contact::edge_of(view.side.points, name));
  };
  if (explanation_.edges &&
      explanation_.is_open(explanation_.excess_m(view, visit.explained_m, lower)) &&
      measures(view, cone(), lower, visit)) {
    edge(item.side, index);
  } else {
    visit.unmeasured = smaller(visit.unmeasured, lower);
  }
}

/// Bounds a region by the distance of its centre: signed distances change no faster than points
/// move.
/// @return false where that can tell no more than is known
bool Measuring::tighten(NearRegion& item) noexcept {
  const SideView& view = memory_.views[item.side];
  RegionBound& bound = memory_.sides[item.side].regions[item.region];
  const double may_prove = bound.upper_since + view.odometer;
  if (may_prove <= item.lower + kWorthTightening * view.delta) return false;
  const Sphere sphere = sphere_of(view, item.region);
  const contact::Target& target = view.side.target;
  const contact::SignedDistance at =
      contact::signed_distance(target, *pace_, view.side.to_target(sphere.centre), image::kNone);
  const double lower = contact::lipschitz_bound(target.surface, at.value) - sphere.radius;
  bound.upper_since = lower - view.odometer;
  bound.lower_until = larger(bound.lower_until, lower + view.odometer);
  item.lower = larger(item.lower, lower);
  return true;
}

double Measuring::edge_bound(const ContactSource& edge, double region_lower) const noexcept {
  const SideView& view = memory_.views[edge.side];
  const SideMemory& side = memory_.sides[edge.side];
  const contact::Surface& surface = view.side.points;
  const std::uint32_t name = view.image().surface_edges[edge.item];
  const std::uint32_t from = contact::vertex_of(surface, name / 3, name % 3);
  const std::uint32_t to = contact::vertex_of(surface, name / 3, (name % 3 + 1) % 3);
  const double length = norm(contact::position(surface, from) - contact::position(surface, to));
  const double ends = side.vertices[from].lower_until + side.vertices[to].lower_until;
  return larger(0.5 * (ends - length) - view.odometer, region_lower);
}

/// A triangle of the other body that is near a vertex.
std::uint32_t Measuring::hint_of(std::uint32_t side, std::uint32_t vertex) const noexcept {
  const std::uint32_t before = memory_.sides[side].vertices[vertex].nearest;
  if (before != image::kNone) return before;
  const SideView& view = memory_.views[side];
  const contact::Surface& target = view.side.target.surface;
  const Vec3d x = view.side.to_target(contact::position(view.side.points, vertex));
  return contact::cell_at(*target.image, vec_cast<float>((1 / target.scale) * x)).triangle;
}

void Measuring::vertex(std::uint32_t side, std::uint32_t index) noexcept {
  const SideView& view = memory_.views[side];
  VertexBound& at = memory_.sides[side].vertices[index];
  if (at.measured_tick == memory_.tick) return;
  at.measured_tick = memory_.tick;
  const contact::SignedDistance distance = contact::contacts_of_vertex(
      view.side, *pace_, index, hint_of(side, index), view.delta, *memory_.scratch);
  at.nearest = distance.foot.triangle;
  at.lower_until =
      contact::lipschitz_bound(view.side.target.surface, distance.value) + view.odometer;
  const Vec3d x = view.side.to_target(contact::position(view.side.points, index));
  const double away = distance.value != 0 ? 1 / distance.value : 0;
  note_nearest(view, {away * (x - distance.foot.point), distance.value, 0, x, distance.foot.point,
                      distance.foot.triangle});
  take({side, index});
}

void Measuring::note_nearest(const SideView& view, const contact::FoundContact& found) noexcept {
  if (found.distance * view.unit_m < out_.nearest.distance_m) {
    out_.nearest = contact_of(view, found);
  }
}

Contact Measuring::contact_of(const SideView& view,
                              const contact::FoundContact& found) const noexcept {
  const Vec3d point = view.world(found.point);
  const Vec3d foot = view.world(found.foot);
  const Vec3d normal = view.to_world * found.normal;
  Contact c;
  c.point_a_m = view.points_of_a ? point : foot;
  c.point_b_m = view.points_of_a ? foot : point;
  c.normal = view.points_of_a ? normal : -normal;
  c.distance_m = found.distance * view.unit_m;
  c.centre_m = point - (0.5 * c.distance_m) * normal;
  c.share = found.weight;
  c.pair = view.pair;
  const image::RegionTriangle& t = view.side.target.surface.image->region_triangles[found.triangle];
  (view.points_of_a ? c.piece_b : c.piece_a) = t.piece;
  return c;
}

void Measuring::edge(std::uint32_t side, std::uint32_t index) noexcept {
  const SideView& view = memory_.views[side];
  std::uint32_t& tick = memory_.sides[side].edge_ticks[index];
  if (tick == memory_.tick) return;
  tick = memory_.tick;
  // With both ends measured it is known how deep the edge may be, and so how far to look.
  const std::uint32_t name = view.image().surface_edges[index];
  const std::uint32_t from = contact::vertex_of(view.side.points, name / 3, name % 3);
  const std::uint32_t to = contact::vertex_of(view.side.points, name / 3, (name % 3 + 1) % 3);
  vertex(side, from);
  vertex(side, to);
  const double lower = edge_bound({side, index}, -view.side.target.surface.scale);
  if (lower > contact::kReach * view.delta) return;
  const std::span<const VertexBound> vertices = memory_.sides[side].vertices;
  contact::contacts_of_edge(
      view.side, view.points, *pace_, name,
      {vertices[from].lower_until - view.odometer, vertices[to].lower_until - view.odometer},
      view.delta, *memory_.scratch);
  take({side, index | ContactSource::kEdge});
}

void Measuring::take(const ContactSource& source) noexcept {
  const SideView& view = memory_.views[source.side];
  for (const contact::FoundContact& found : memory_.scratch->found.all()) {
    if (out_.contacts == memory_.contacts.size()) {
      out_.contacts_full = true;
      return;
    }
    if (source.is_edge()) note_nearest(view, found);
    memory_.sources[out_.contacts] = source;
    memory_.contacts[out_.contacts++] = contact_of(view, found);
  }
}

}  // namespace palpate::regions

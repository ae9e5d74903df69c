// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hull/growing_hull.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace palpate::bake {
namespace {

constexpr std::size_t kFewFacets = 64;  // that are sooner tried one by one

std::size_t corner_of(const Triangle& vertices, std::uint32_t v) {
  const std::size_t corner = vertices[0] == v ? 0 : vertices[1] == v ? 1 : 2;
  assert(vertices[corner] == v);
  return corner;
}

bool has_corner(const Triangle& vertices, std::uint32_t v) {
  return vertices[0] == v || vertices[1] == v || vertices[2] == v;
}

}  // namespace

GrowingHull::GrowingHull(std::span<const PointF> points)
    : points_(points), facet_of_(points.size(), kNone), cone_at_(points.size(), kNone) {}

int GrowingHull::side(const Triangle& plane, std::uint32_t v) const {
  if (has_corner(plane, v)) return 0;
  return orient_3d(points_[plane[0]], points_[plane[1]], points_[plane[2]], points_[v]);
}

int GrowingHull::side(const Facet& facet, std::uint32_t v) const { return side(facet.vertices, v); }

/// Calls visit(facet index) around a corner of the triangulation until it returns true.
template <class Visit>
void GrowingHull::around(std::uint32_t v, Visit visit) const {
  const std::uint32_t first = facet_of_[v];
  std::uint32_t f = first;
  do {
    if (visit(f)) return;
    f = facets_[f].neighbours[(corner_of(facets_[f].vertices, v) + 2) % 3];
  } while (f != first);
}

void GrowingHull::start(std::span<const std::uint32_t> ring, bool real) {
  assert(ring.size() >= 3);
  for (const std::uint32_t v : used_) facet_of_[v] = kNone;
  used_.assign(ring.begin(), ring.end());
  free_.clear();
  facets_.clear();
  steps_.clear();
  removed_.clear();
  added_.clear();
  marked_.clear();
  horizon_.clear();
  visit_ = 0;
  flat_ = true;
  has_inner_ = false;

  // Upper side: the fan of ring[0]; lower side: the same triangles turned over, `above` further on.
  const auto above = static_cast<std::uint32_t>(ring.size() - 2);
  facets_.resize(std::size_t{2} * above);
  for (std::uint32_t k = 0; k < above; ++k) {
    const std::uint32_t last = above - 1;
    Facet& top = facets_[k];
    Facet& bottom = facets_[above + k];
    top.vertices = {ring[0], ring[k + 1], ring[k + 2]};
    bottom.vertices = {ring[0], ring[k + 2], ring[k + 1]};
    top.neighbours = {k == 0 ? above : k - 1, above + k, k == last ? above + k : k + 1};
    bottom.neighbours = {k == last ? k : above + k + 1, k, k == 0 ? 0 : above + k - 1};
    top.alive = bottom.alive = true;
    top.real = real;
    for (const std::uint32_t v : top.vertices) facet_of_[v] = k;
  }
}

std::uint32_t GrowingHull::find_visible(std::uint32_t v, std::uint32_t near) {
  const bool start_near = near != kNone && has(near);
  std::uint32_t found = kNone;
  if (start_near)
    around(near, [&](std::uint32_t f) {
      if (side(facets_[f], v) > 0) found = f;
      return found != kNone;
    });
  if (found != kNone) return found;
  if (!flat_ && facets_.size() > kFewFacets && (has_inner_ || find_inner())) {
    std::uint32_t from = start_near ? facet_of_[near] : 0;
    while (!facets_[from].alive) ++from;
    const std::uint32_t below = find_below(v, from);
    if (below != kNone) return side(facets_[below], v) > 0 ? below : kNone;
  }
  for (std::uint32_t f = 0; found == kNone && f < facets_.size(); ++f)
    if (facets_[f].alive && side(facets_[f], v) > 0) found = f;
  return found;
}

/// A point strictly below all facets. False where none is found: the hull is thin.
bool GrowingHull::find_inner() {
  std::array<double, 3> sum{};
  double corners = 0;
  for (const Facet& facet : facets_) {
    if (!facet.alive) continue;
    for (const std::uint32_t v : facet.vertices)
      for (std::size_t i = 0; i < 3; ++i) sum[i] += static_cast<double>(points_[v][i]);
    corners += 3;
  }
  for (std::size_t i = 0; i < 3; ++i) inner_[i] = static_cast<float>(sum[i] / corners);
  has_inner_ = std::all_of(facets_.begin(), facets_.end(), [&](const Facet& facet) {
    const Triangle& t = facet.vertices;
    return !facet.alive || orient_3d(points_[t[0]], points_[t[1]], points_[t[2]], inner_) < 0;
  });
  inner_since_ = steps_.size();
  return has_inner_;
}

/// Walks to a facet that v sees, or to the one through which the ray from inner_ to v leaves the
/// hull: where v does not see that one it is in the hull. kNone where the walk goes round in a
/// plane.
///
/// From facet to facet the ray's parameter at their planes falls (the triangulation is the central
/// projection of a convex surface), except between facets of one plane.
std::uint32_t GrowingHull::find_below(std::uint32_t v, std::uint32_t from) const {
  for (std::size_t step = 0; step < facets_.size(); ++step) {
    const Facet& facet = facets_[from];
    if (side(facet, v) > 0) return from;
    std::uint32_t next = kNone;
    for (std::size_t k = 0; next == kNone && k < 3; ++k) {
      const std::size_t i = (step + k) % 3;  // so that ways round in a plane are soon left
      const std::uint32_t a = facet.vertices[i], b = facet.vertices[(i + 1) % 3];
      if (orient_3d(inner_, points_[a], points_[b], points_[v]) < 0) next = facet.neighbours[i];
    }
    if (next == kNone) return from;
    from = next;
  }
  return kNone;
}

/// Logs the facets that v sees, and their horizon. False where one of them is real.
bool GrowingHull::collect_visible(std::uint32_t v, std::uint32_t first) {
  if (facets_[first].real) return false;
  ++visit_;
  std::size_t next = removed_.size();
  removed_.push_back(first);
  facets_[first].visit = visit_;
  for (; next < removed_.size(); ++next) {
    const std::uint32_t f = removed_[next];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t g = facets_[f].neighbours[i];
      if (facets_[g].visit == visit_) continue;
      const int sign = side(facets_[g], v);
      if (sign > 0) {
        if (facets_[g].real) return false;
        facets_[g].visit = visit_;
        removed_.push_back(g);
        continue;
      }
      const std::uint32_t from = facets_[f].vertices[i];
      const std::uint32_t to = facets_[f].vertices[(i + 1) % 3];
      const auto slot = static_cast<std::uint32_t>(corner_of(facets_[g].vertices, to));
      horizon_.push_back({g, slot, f, from, to, sign == 0 && facets_[g].real});
    }
  }
  return true;
}

std::uint32_t GrowingHull::new_facet() {
  if (free_.empty()) {
    facets_.emplace_back();
    return static_cast<std::uint32_t>(facets_.size() - 1);
  }
  const std::uint32_t f = free_.back();
  free_.pop_back();
  return f;
}

void GrowingHull::raise_cone(std::uint32_t v, const Step& step) {
  for (std::size_t r = step.removed; r < removed_.size(); ++r) {
    Facet& facet = facets_[removed_[r]];
    facet.alive = false;
    for (const std::uint32_t corner : facet.vertices) facet_of_[corner] = kNone;
  }
  for (std::size_t h = step.horizon; h < horizon_.size(); ++h) {
    const Horizon& edge = horizon_[h];
    const std::uint32_t f = new_facet();
    added_.push_back(f);
    facets_[f] = {{edge.from, edge.to, v}, {edge.outside, kNone, kNone}, 0, true, edge.real};
    facets_[edge.outside].neighbours[edge.slot] = f;
    cone_at_[edge.from] = f;
    facet_of_[edge.from] = f;
  }
  for (std::size_t a = step.added; a < added_.size(); ++a) {
    Facet& facet = facets_[added_[a]];
    const std::uint32_t following = cone_at_[facet.vertices[1]];
    facet.neighbours[1] = following;
    facets_[following].neighbours[2] = added_[a];
  }
  facet_of_[v] = added_[step.added];
  used_.push_back(v);
  flat_ = false;
}

void GrowingHull::open_step(std::uint32_t vertex) {
  steps_.push_back(
      {removed_.size(), horizon_.size(), added_.size(), marked_.size(), vertex, flat_});
}

bool GrowingHull::insert(std::uint32_t v, std::uint32_t near) {
  if (has(v)) return true;
  const std::uint32_t first = find_visible(v, near);
  if (first == kNone) return true;
  open_step(v);
  if (!collect_visible(v, first)) {
    removed_.resize(steps_.back().removed);
    horizon_.resize(steps_.back().horizon);
    steps_.pop_back();
    return false;
  }
  raise_cone(v, steps_.back());
  return true;
}

bool GrowingHull::supported_by(const Triangle& plane, std::uint32_t near) const {
  bool supported = true;
  const auto above = [&](std::uint32_t f) {
    for (const std::uint32_t v : facets_[f].vertices)
      if (side(plane, v) > 0) supported = false;
    return !supported;
  };
  if (near != kNone && has(near)) {
    // The hull lies in its tangent cone at a corner: what the corner's star does not exceed, the
    // hull does not.
    around(near, above);
    return supported;
  }
  for (std::uint32_t f = 0; supported && f < facets_.size(); ++f)
    if (facets_[f].alive) above(f);
  return supported;
}

void GrowingHull::mark_real(const Triangle& plane, std::uint32_t near) {
  assert(!flat_);
  open_step(kNone);
  const std::size_t begin = marked_.size();
  const auto mark_if_inside = [&](std::uint32_t f) {
    if (facets_[f].real) return;
    for (const std::uint32_t v : facets_[f].vertices)
      if (side(plane, v) != 0) return;
    facets_[f].real = true;
    marked_.push_back(f);
  };
  if (near != kNone && has(near)) {
    around(near, [&](std::uint32_t f) {
      mark_if_inside(f);
      return false;
    });
  } else {
    for (std::uint32_t f = 0; f < facets_.size(); ++f)
      if (facets_[f].alive) mark_if_inside(f);
  }
  for (std::size_t m = begin; m < marked_.size(); ++m)
    for (const std::uint32_t g : facets_[marked_[m]].neighbours) mark_if_inside(g);
}

void GrowingHull::drop_step() {
  const Step step = steps_.back();
  steps_.pop_back();
  if (steps_.size() < inner_since_) has_inner_ = false;
  for (std::size_t m = step.marked; m < marked_.size(); ++m) facets_[marked_[m]].real = false;
  for (std::size_t a = added_.size(); a-- > step.added;) {
    facets_[added_[a]].alive = false;
    free_.push_back(added_[a]);
  }
  if (step.vertex != kNone) facet_of_[step.vertex] = kNone;
  for (std::size_t h = step.horizon; h < horizon_.size(); ++h)
    facets_[horizon_[h].outside].neighbours[horizon_[h].slot] = horizon_[h].inside;
  for (std::size_t r = step.removed; r < removed_.size(); ++r) {
    Facet& facet = facets_[removed_[r]];
    facet.alive = true;
    for (const std::uint32_t corner : facet.vertices) facet_of_[corner] = removed_[r];
  }
  removed_.resize(step.removed);
  horizon_.resize(step.horizon);
  added_.resize(step.added);
  marked_.resize(step.marked);
  flat_ = step.was_flat;
}

void GrowingHull::rollback(Mark mark) {
  while (steps_.size() > mark) drop_step();
}

void GrowingHull::commit() {
  free_.insert(free_.end(), removed_.begin(), removed_.end());
  removed_.clear();
  horizon_.clear();
  added_.clear();
  marked_.clear();
  steps_.clear();
  inner_since_ = 0;
}

std::vector<Triangle> GrowingHull::triangles() const {
  std::vector<Triangle> living;
  for (const Facet& facet : facets_)
    if (facet.alive) living.push_back(facet.vertices);
  return living;
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/patch_hulls.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "host_bake/decompose/flat_cover.hpp"
#include "host_bake/hull/predicates.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kFewPoints = 24;  // that are inserted without a hint where to look
constexpr float kMargin = 3e-7F;        // kShrink_rel and rounding of floats below 2

}  // namespace

FaceBox with_margin(FaceBox box) {
  for (std::size_t i = 0; i < 3; ++i) {
    box.low[i] -= kMargin;
    box.high[i] += kMargin;
  }
  return box;
}

/// From the first face with area that has not the point `without`; false where there is none.
bool HullBuilder::start(std::span<const PointF> points, std::span<const Triangle> faces,
                        std::uint32_t without) {
  if (points.size() > points_.size()) {
    points_.resize(2 * points.size() + 64);
    hull_.emplace(points_);
  }
  std::copy(points.begin(), points.end(), points_.begin());
  used_ = kept_ = static_cast<std::uint32_t>(points.size());
  for (const Triangle& f : faces) {
    if (f[0] == without || f[1] == without || f[2] == without) continue;
    if (collinear(points[f[0]], points[f[1]], points[f[2]])) continue;
    hull_->start(f, false);
    return true;
  }
  return false;
}

/// Corners in the plane of a flat hull wait for one off it, so there are two rounds.
void HullBuilder::insert_all(std::size_t points, std::uint32_t without) {
  for (int round = 0; round < 2; ++round) {
    const bool was_flat = hull_->flat();
    for (std::uint32_t v = 0; v < points; ++v)
      if (v != without)
        static_cast<void>(hull_->insert(v, GrowingHull::kNone));  // nothing is real to refuse it
    if (!was_flat || hull_->flat()) return;
  }
}

void HullBuilder::insert_walking(const PatchShape& shape, const std::vector<std::uint32_t>& order,
                                 std::uint32_t without) {
  for (int round = 0; round < 2; ++round) {
    const bool was_flat = hull_->flat();
    for (const std::uint32_t f : order)
      for (std::size_t i = 0; i < 3; ++i) {
        const Triangle& c = shape.corners[f];
        if (c[i] == without || hull_->has(c[i])) continue;
        std::uint32_t near = GrowingHull::kNone;
        for (const std::uint32_t other : c)
          if (hull_->has(other)) near = other;
        static_cast<void>(hull_->insert(c[i], near));
      }
    if (!was_flat || hull_->flat()) return;
  }
}

bool HullBuilder::fills_polygon(const PatchShape& shape, const Ring* ring,
                                ShapeGatherer& gatherer) {
  if (shape.faces.size() == 1) return true;
  gatherer.index(shape);
  NormalMesh mesh;
  mesh.points = shape.points;
  mesh.faces.assign(shape.corners.begin(), shape.corners.end());
  SurfaceEdges edges;
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < shape.faces.size(); ++i) {
    all.push_back(i);
    for (std::uint32_t h = 3 * shape.faces[i]; h < 3 * shape.faces[i] + 3; ++h) {
      const std::uint32_t t = gatherer.twin_after(ring, h);
      const std::uint32_t g = t == kNothing ? kNothing : gatherer.place(t / 3);
      edges.twin.push_back(g == kNothing ? SurfaceEdges::kNone : 3 * g + t % 3);
    }
  }
  const std::vector<std::uint32_t> owner(all.size(), 0);
  return fills_convex_polygon(mesh, edges, all, owner, 0);
}

void HullBuilder::insert(const PatchShape& shape, const Ring* ring, ShapeGatherer& gatherer,
                         std::uint32_t without) {
  if (shape.points.size() <= kFewPoints) {
    insert_all(shape.points.size(), without);
  } else {
    insert_walking(shape, gatherer.walk(shape, ring), without);
  }
}

/// False where the hull is not solid without the new vertex.
bool HullBuilder::insert_apex_last(const PatchShape& shape, const Ring* ring,
                                   ShapeGatherer& gatherer, FaceBox& out_grown) {
  if (shape.apex == kNothing || !start(shape.points, shape.corners, shape.apex)) return false;
  insert(shape, ring, gatherer, shape.apex);
  if (hull_->flat()) return false;
  hull_->commit();
  std::uint32_t near = GrowingHull::kNone;
  for (std::size_t f = 0; near == GrowingHull::kNone && f < shape.faces.size(); ++f)
    for (const std::uint32_t v : shape.corners[f])
      if (shape.changed[f] && hull_->has(v)) near = v;
  static_cast<void>(hull_->insert(shape.apex, near));
  out_grown = palpate::bake::box_of({});
  if (hull_->replaced().empty()) return true;
  out_grown.add(shape.points[shape.apex]);
  for (const std::uint32_t f : hull_->replaced())
    for (const std::uint32_t v : hull_->slots()[f].vertices) out_grown.add(shape.points[v]);
  // Facets that are inside now kept things kShrink_rel away from the shrunk hull.
  out_grown = with_margin(out_grown);
  return true;
}

HullKind HullBuilder::build(const PatchShape& shape, const Ring* ring, ShapeGatherer& gatherer,
                            ShrunkHull& out_hull, FaceBox& out_grown) {
  if (shape.faces.size() == 1) return HullKind::empty;
  if (!insert_apex_last(shape, ring, gatherer, out_grown)) {
    if (!start(shape.points, shape.corners, kNothing)) return HullKind::empty;
    insert(shape, ring, gatherer, kNothing);
    out_grown = palpate::bake::box_of(shape.points);
  }
  if (!hull_->flat()) {
    out_hull.build(*hull_);
    if (!out_hull.thin()) return HullKind::solid;
  }
  if (!fills_polygon(shape, ring, gatherer)) return HullKind::refused;
  return hull_->flat() ? HullKind::empty : HullKind::solid;
}

bool HullBuilder::add(const PointF& point, std::vector<PointF>& out_grown) {
  if (used_ == kept_) hull_->commit();
  const std::size_t seen = hull_->replaced().size();
  points_[used_] = point;
  static_cast<void>(hull_->insert(used_, GrowingHull::kNone));
  if (!hull_->has(used_)) return false;
  ++used_;
  std::vector<std::uint32_t> corners;
  for (const std::uint32_t f : hull_->replaced().subspan(seen))
    for (const std::uint32_t v : hull_->slots()[f].vertices) corners.push_back(v);
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  for (const std::uint32_t v : corners) out_grown.push_back(points_[v]);
  out_grown.push_back(point);
  return true;
}

void HullBuilder::keep() {
  hull_->commit();
  kept_ = used_;
}

void HullBuilder::take_back() {
  hull_->rollback(0);
  used_ = kept_;
}

HullKind HullBuilder::build(std::span<const PointF> points, ShrunkHull& out_hull) {
  std::vector<Triangle> faces;
  for (std::uint32_t i = 2; i < points.size(); ++i) faces.push_back({0, i - 1, i});
  if (!start(points, faces, kNothing)) return HullKind::empty;
  insert_all(points.size(), kNothing);
  if (hull_->flat()) return HullKind::empty;
  out_hull.build(*hull_);
  return HullKind::solid;
}

}  // namespace palpate::bake

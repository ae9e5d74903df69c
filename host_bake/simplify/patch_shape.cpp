// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/patch_shape.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "host_bake/decompose/geometry.hpp"

namespace palpate::bake {

bool clearly_solid(std::span<const PointF> points) {
  constexpr double kThick = 1e-5;
  const Vec3d origin = position(points.front());
  struct Farthest {
    double measure = 0;
    Vec3d offset{};
  };
  const auto farthest = [&](auto measure) {
    Farthest best;
    for (const PointF& p : points) {
      const Vec3d d = position(p) - origin;
      if (const double m = measure(d); m > best.measure) best = {m, d};
    }
    return best;
  };
  const Farthest end = farthest([](Vec3d d) { return norm(d); });
  if (end.measure < kThick) return false;
  const Farthest side = farthest([&](Vec3d d) { return norm(cross(end.offset, d)) / end.measure; });
  if (side.measure < kThick) return false;
  const Vec3d n = cross(end.offset, side.offset);
  return farthest([&](Vec3d d) { return std::abs(dot(n, d)) / norm(n); }).measure > kThick;
}

FaceBox box_of(std::span<const PointF> points) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  FaceBox box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const PointF& p : points) box.add(p);
  return box;
}

FaceBox box_of(const PointF& a, const PointF& b, const PointF& c) {
  FaceBox box{a, a};
  box.add(b);
  box.add(c);
  return box;
}

ShapeGatherer::ShapeGatherer(const Surface& surface)
    : surface_(surface),
      vertex_mark_(surface.points.size(), 0),
      vertex_place_(surface.points.size(), 0),
      face_mark_(surface.faces.size(), 0),
      face_place_(surface.faces.size(), 0) {}

void ShapeGatherer::gather(const PatchLists& patches, std::span<const std::uint32_t> members,
                           const Ring* ring, PatchShape& out_shape) {
  PatchShape& shape = out_shape;
  shape.patch = members.front();
  shape.faces.clear();
  shape.corners.clear();
  shape.points.clear();
  shape.vertices.clear();
  shape.changed.clear();
  shape.apex = kNothing;
  const std::uint32_t kept = ring != nullptr ? ring->kept : kNothing;
  const std::uint32_t removed = ring != nullptr ? ring->removed : kNothing;
  ++vertex_turn_;
  for (const std::uint32_t patch : members) {
    patches.for_each(patch, [&](std::uint32_t f) {
      if (ring != nullptr && (f == ring->edge / 3 || f == ring->twin / 3)) return;
      Triangle local{};
      char changed = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        std::uint32_t v = surface_.faces[f][i];
        if (v == removed) v = kept;
        if (vertex_mark_[v] != vertex_turn_) {
          vertex_mark_[v] = vertex_turn_;
          vertex_place_[v] = static_cast<std::uint32_t>(shape.points.size());
          if (v == kept) shape.apex = vertex_place_[v];
          shape.points.push_back(surface_.points[v]);
          shape.vertices.push_back(v);
        }
        if (v == kept) changed = 1;
        local[i] = vertex_place_[v];
      }
      shape.faces.push_back(f);
      shape.corners.push_back(local);
      shape.changed.push_back(changed);
    });
  }
}

std::uint32_t ShapeGatherer::twin_after(const Ring* ring, std::uint32_t h) const {
  const std::uint32_t t = surface_.twin[h];
  if (ring == nullptr || t == kNothing) return t;
  for (const std::uint32_t e : {ring->edge, ring->twin}) {
    if (e == kNothing || t / 3 != e / 3) continue;
    return surface_.twin[t == Surface::next(e) ? Surface::previous(e) : Surface::next(e)];
  }
  return t;
}

void ShapeGatherer::index(const PatchShape& shape) {
  ++face_turn_;
  for (std::uint32_t i = 0; i < shape.faces.size(); ++i) {
    face_mark_[shape.faces[i]] = face_turn_;
    face_place_[shape.faces[i]] = i;
  }
}

const std::vector<std::uint32_t>& ShapeGatherer::walk(const PatchShape& shape, const Ring* ring) {
  index(shape);
  order_.clear();
  seen_.assign(shape.faces.size(), 0);
  const auto reach = [this](std::uint32_t face) {
    if (seen_[face] == 0) order_.push_back(face);
    seen_[face] = 1;
  };
  std::size_t next = 0;
  for (std::uint32_t seed = 0; seed < shape.faces.size(); ++seed) {
    reach(seed);
    for (; next < order_.size(); ++next) {
      const std::uint32_t f = shape.faces[order_[next]];
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        const std::uint32_t t = twin_after(ring, h);
        if (t != kNothing && place(t / 3) != kNothing) reach(place(t / 3));
      }
    }
  }
  return order_;
}

}  // namespace palpate::bake

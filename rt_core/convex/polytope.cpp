// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/polytope.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/convex/simplex.hpp"

namespace palpate::convex {
namespace {

constexpr std::uint16_t kNoEdge = 0xffff;

constexpr std::uint32_t next(std::uint32_t edge) noexcept { return edge == 2 ? 0 : edge + 1; }

std::uint16_t narrow(std::uint32_t index) noexcept { return static_cast<std::uint16_t>(index); }

/// Sets the plane from the corners; false where they have no area.
bool set_plane(const Polytope& p, PolytopeFace& face) noexcept {
  const Vec3d corner = p.vertices[face.vertices[0]].point;
  double scale = 0;
  const Vec3d normal = area_normal(corner, p.vertices[face.vertices[1]].point,
                                   p.vertices[face.vertices[2]].point, scale);
  const double normal2 = squared_norm(normal);
  if (!(normal2 > kMinSine * kMinSine * scale)) return false;
  face.normal = (1 / sqrt_of(normal2)) * normal;
  face.offset = dot(face.normal, corner);
  return true;
}

/// The edge of `face` that starts at vertex `from`.
std::uint32_t edge_at(const PolytopeFace& face, std::uint16_t from) noexcept {
  for (std::uint32_t k = 0; k < 2; ++k) {
    if (face.vertices[k] == from) return k;
  }
  return 2;
}

/// Marks the faces that see the vertex and hang together with `first`; their other borders are the
/// horizon. False where it has more edges than fit.
bool find_horizon(Polytope& p, std::uint32_t first, Vec3d vertex, double coplanar) noexcept {
  p.horizon_count = 0;
  p.faces[first].visible = true;
  p.pending[0] = narrow(first);
  std::uint32_t marked = 1;
  for (std::uint32_t done = 0; done < marked; ++done) {  // each face is marked once
    const PolytopeFace& face = p.faces[p.pending[done]];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint16_t across = face.across[k];
      PolytopeFace& other = p.faces[across];
      if (other.visible) continue;
      if (dot(other.normal, vertex) - other.offset > -coplanar) {
        other.visible = true;
        p.pending[marked++] = across;
      }
    }
  }
  for (std::uint32_t i = 0; i < marked; ++i) {
    const PolytopeFace& face = p.faces[p.pending[i]];
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (p.faces[face.across[k]].visible) continue;
      if (p.horizon_count == kMaxPolytopeVertices) return false;
      const std::uint16_t to = face.vertices[next(k)];
      p.horizon[p.horizon_count++] = {face.vertices[k], to, face.across[k],
                                      narrow(edge_at(p.faces[face.across[k]], to))};
    }
  }
  for (std::uint32_t i = 0; i < marked; ++i) {
    p.faces[p.pending[i]].live = false;
    p.faces[p.pending[i]].visible = false;
    p.free_faces[p.free_count++] = p.pending[i];
  }
  return true;
}

/// Is the horizon one loop that meets no vertex twice? Leaves the edges linked by edge_from.
bool link_horizon(Polytope& p) noexcept {
  for (std::uint32_t v = 0; v < p.vertex_count; ++v) p.edge_from[v] = kNoEdge;
  for (std::uint32_t i = 0; i < p.horizon_count; ++i) {
    if (p.edge_from[p.horizon[i].from] != kNoEdge) return false;
    p.edge_from[p.horizon[i].from] = narrow(i);
  }
  std::uint32_t edge = 0;
  for (std::uint32_t i = 0; i < p.horizon_count; ++i) {
    edge = p.edge_from[p.horizon[edge].to];
    if (edge == kNoEdge) return false;
    if (edge == 0) return i + 1 == p.horizon_count && i >= 2;
  }
  return false;
}

std::uint32_t take_face(Polytope& p) noexcept {
  if (p.free_count > 0) return p.free_faces[--p.free_count];
  return p.face_count < kMaxPolytopeFaces ? p.face_count++ : kMaxPolytopeFaces;
}

/// The fan between the last vertex and the horizon.
bool close_fan(Polytope& p) noexcept {
  const std::uint16_t apex = narrow(p.vertex_count - 1);
  std::uint32_t edge = 0;
  std::uint32_t first = 0;
  std::uint32_t previous = 0;
  for (std::uint32_t i = 0; i < p.horizon_count; ++i) {
    const HorizonEdge& h = p.horizon[edge];
    const std::uint32_t slot = take_face(p);
    if (slot == kMaxPolytopeFaces) return false;
    PolytopeFace& face = p.faces[slot];
    face = {{}, 0, {h.from, h.to, apex}, {h.outer, 0, narrow(previous)}, true, false};
    if (!set_plane(p, face)) {
      face.normal = p.faces[h.outer].normal;
      face.offset = p.faces[h.outer].offset;
    }
    p.faces[h.outer].across[h.outer_edge] = narrow(slot);
    if (i == 0) {
      first = slot;
    } else {
      p.faces[previous].across[1] = narrow(slot);
    }
    previous = slot;
    edge = p.edge_from[h.to];
  }
  p.faces[previous].across[1] = narrow(first);
  p.faces[first].across[2] = narrow(previous);
  return true;
}

}  // namespace

bool start(Polytope& p, const DifferencePoint (&corners)[4]) noexcept {
  const Vec3d base = corners[3].point;
  const Vec3d u = corners[0].point - base;
  const Vec3d v = corners[1].point - base;
  const Vec3d w = corners[2].point - base;
  const bool turned = dot(u, cross(v, w)) < 0;
  p.vertex_count = 4;
  p.face_count = 4;
  p.free_count = 0;
  for (std::uint32_t i = 0; i < 4; ++i) p.vertices[i] = corners[i];
  if (turned) {
    p.vertices[0] = corners[1];
    p.vertices[1] = corners[0];
  }
  // Face i lies across edge j of face k as in kAcross[k][j] = i.
  constexpr std::uint16_t kCorners[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  constexpr std::uint16_t kAcross[4][3] = {{2, 3, 1}, {0, 3, 2}, {1, 3, 0}, {2, 1, 0}};
  for (std::uint32_t f = 0; f < 4; ++f) {
    PolytopeFace& face = p.faces[f];
    face = {{}, 0, {}, {}, true, false};
    for (std::uint32_t k = 0; k < 3; ++k) {
      face.vertices[k] = kCorners[f][k];
      face.across[k] = kAcross[f][k];
    }
    if (!set_plane(p, face)) return false;
  }
  return true;
}

std::uint32_t lowest_face(const Polytope& p) noexcept {
  std::uint32_t best = kMaxPolytopeFaces;
  for (std::uint32_t f = 0; f < p.face_count; ++f) {
    if (!p.faces[f].live) continue;
    if (best == kMaxPolytopeFaces || p.faces[f].offset < p.faces[best].offset) best = f;
  }
  PALPATE_ASSERT(best < kMaxPolytopeFaces);
  return best;
}

bool add_vertex(Polytope& p, std::uint32_t face, const DifferencePoint& vertex,
                double coplanar) noexcept {
  if (p.vertex_count == kMaxPolytopeVertices) return false;
  if (!find_horizon(p, face, vertex.point, coplanar) || !link_horizon(p)) return false;
  p.vertices[p.vertex_count++] = vertex;
  return close_fan(p);
}

}  // namespace palpate::convex

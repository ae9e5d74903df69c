// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh that shrinks edge by edge: half-edges in dense arrays, nothing allocated an
// element.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_bake/hull/hull.hpp"
#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

inline constexpr std::uint32_t kNothing = 0xffffffffu;

/// What an edge collapse leaves around the new vertex, counter-clockwise. The new vertex takes the
/// place of the edge's start.
struct Ring {
  std::uint32_t edge = kNothing;  ///< the half-edge, from `kept` to `removed`
  std::uint32_t twin = kNothing;
  std::uint32_t kept = kNothing, removed = kNothing;
  bool closed = false;                  ///< the new vertex is not on a boundary
  std::vector<std::uint32_t> spokes;    ///< half-edges of the changed faces that leave either end
  std::vector<std::uint32_t> vertices;  ///< face i is (new, vertices[i], vertices[i + 1]); one more
                                        ///< than spokes where open
  std::vector<std::uint32_t> far;       ///< half-edge across the rim of face i; kNothing: boundary

  [[nodiscard]] std::size_t faces() const { return spokes.size(); }
  [[nodiscard]] std::uint32_t left(std::size_t i) const { return vertices[i]; }
  [[nodiscard]] std::uint32_t right(std::size_t i) const {
    return vertices[i + 1 == vertices.size() ? 0 : i + 1];
  }
};

/// Half-edge 3 f + i runs from corner i to corner i + 1 of face f. Dead faces have kNothing as
/// corners.
class Surface {
 public:
  /// Longer rings are refused: work on a vertex is quadratic in its neighbours.
  static constexpr std::size_t kMaxRing = 64;

  /// Every edge has one face or two, oppositely oriented; otherwise it counts as boundary. O(n log
  /// n).
  explicit Surface(const NormalMesh& mesh);

  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t previous(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

  [[nodiscard]] std::uint32_t start(std::uint32_t h) const { return faces[h / 3][h % 3]; }
  [[nodiscard]] std::uint32_t end(std::uint32_t h) const { return start(next(h)); }
  [[nodiscard]] std::uint32_t apex(std::uint32_t h) const { return start(previous(h)); }
  [[nodiscard]] bool alive(std::uint32_t face) const { return faces[face][0] != kNothing; }

  /// The ring that collapsing half-edge h would leave. False where the collapse would change the
  /// topology (link condition; Dey, Edelsbrunner, Guha, Nekhayev 1999), take a face's last
  /// neighbours away, or leave a ring longer than kMaxRing.
  [[nodiscard]] bool find_ring(std::uint32_t h, Ring& out_ring) const;

  /// Collapses as find_ring() described, the new vertex at `position`.
  void collapse(const Ring& ring, const PointF& position);

  /// Half-edges that leave v, counter-clockwise; from the boundary on where there is one.
  void find_fan(std::uint32_t v, std::vector<std::uint32_t>& out_half_edges) const;

  std::vector<PointF> points;
  std::vector<Face> faces;
  std::vector<std::uint32_t> twin;
  std::uint32_t living_faces = 0;

 private:
  [[nodiscard]] std::uint32_t turn_left(const Ring& ring, std::uint32_t spoke) const;
  [[nodiscard]] std::uint32_t turn_right(const Ring& ring, std::uint32_t spoke) const;
  [[nodiscard]] bool on_boundary(std::uint32_t v) const;

  std::vector<std::uint32_t> leaving_;  // a living half-edge that leaves each vertex
};

}  // namespace palpate::bake

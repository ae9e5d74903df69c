// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces meet at each edge, and how: convex, flat or reflex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

enum class EdgeKind : std::uint8_t {
  boundary,  ///< one face, or more than two, or two that disagree on the direction
  reflex,    ///< the faces form a notch, or are folded back onto each other
  flat,      ///< both in one plane, facing the same way
  convex,    ///< the faces form a crest; or one of them has no area, which decides nothing
};

/// Half-edge 3 f + i runs from corner i to corner i + 1 of face f.
struct SurfaceEdges {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> twin;  ///< the same edge in the other face; kNone on the boundary
  std::vector<EdgeKind> kind;       ///< equal for twins
  std::vector<char> degenerate;     ///< of each face: corners in line, exactly

  /// A patch may grow over it.
  [[nodiscard]] bool crossable(std::size_t half_edge) const {
    return kind[half_edge] == EdgeKind::flat || kind[half_edge] == EdgeKind::convex;
  }
};

/// Decided exactly on the float vertices. O(n log n).
SurfaceEdges surface_edges(const NormalMesh& mesh);

inline std::uint32_t edge_start(const NormalMesh& mesh, std::size_t half_edge) {
  return mesh.faces[half_edge / 3][half_edge % 3];
}
inline std::uint32_t edge_end(const NormalMesh& mesh, std::size_t half_edge) {
  return mesh.faces[half_edge / 3][(half_edge % 3 + 1) % 3];
}
/// The corner of the half-edge's face that is not on it.
inline std::uint32_t edge_apex(const NormalMesh& mesh, std::size_t half_edge) {
  return mesh.faces[half_edge / 3][(half_edge % 3 + 2) % 3];
}

/// Each face's distance, in faces, from the nearest face with a boundary or reflex edge; kNone
/// where there is none within reach. The crest order of Ehmann and Lin 2001.
std::vector<std::uint32_t> crest_distance(const SurfaceEdges& edges);

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/topology.hpp"

#include <algorithm>
#include <tuple>

namespace palpate::bake {

std::vector<Side> sorted_sides(const std::vector<Face>& faces) {
  std::vector<Side> sides;
  sides.reserve(3 * faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (repeats_vertex(faces[f])) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = faces[f][i];
      const std::uint32_t to = faces[f][(i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), f, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
  });
  return sides;
}

void join_corners(Sets& corners, const std::vector<Face>& faces, const Side& a, const Side& b) {
  for (const std::uint32_t vertex : {a.low, a.high}) {
    corners.join(3 * a.face + corner_of(faces[a.face], vertex),
                 3 * b.face + corner_of(faces[b.face], vertex));
  }
}

Components components_of(const std::vector<Face>& faces, std::span<const Side> sides) {
  Sets sets(faces.size());
  for_each_edge(sides, [&sets](std::span<const Side> edge) {
    for (const Side& side : edge) sets.join(edge.front().face, side.face);
  });
  Components result;
  result.of_face.assign(faces.size(), kNoComponent);
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (repeats_vertex(faces[f])) continue;
    const std::uint32_t root = sets.find(f);
    // The root is the smallest face of its set, so it has been numbered before all others.
    if (root == f) {
      result.of_face[f] = static_cast<std::uint32_t>(result.closed.size());
      result.closed.push_back(1);
    } else {
      result.of_face[f] = result.of_face[root];
    }
  }
  for_each_edge(sides, [&result](std::span<const Side> edge) {
    if (edge.size() == 1) result.closed[result.of_face[edge.front().face]] = 0;
  });
  return result;
}

}  // namespace palpate::bake

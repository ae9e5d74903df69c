// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/pack/adjacency.hpp"

#include <algorithm>
#include <utility>

namespace palpate::bake {

Adjacency adjacency(std::span<const std::array<std::uint32_t, 3>> faces, std::uint32_t vertices) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(6 * faces.size());
  for (const auto& f : faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges.emplace_back(f[i], f[(i + 1) % 3]);
      edges.emplace_back(f[(i + 1) % 3], f[i]);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  Adjacency out;
  out.starts.assign(vertices + 1, 0);
  out.neighbours.reserve(edges.size());
  for (const auto& [from, to] : edges) {
    ++out.starts[from + 1];
    out.neighbours.push_back(to);
  }
  for (std::uint32_t v = 0; v < vertices; ++v) out.starts[v + 1] += out.starts[v];
  return out;
}

}  // namespace palpate::bake

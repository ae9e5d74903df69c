// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/slivers.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "host_bake/mesh/topology.hpp"
#include "rt_core/image/triangle_normal.hpp"

namespace palpate::bake {
namespace {

/// A flip may make the next one possible, along a row of slivers.
constexpr int kMostRounds = 8;

using Directed = std::pair<std::uint32_t, std::uint32_t>;

double distance2(const NormalMesh& mesh, std::uint32_t u, std::uint32_t v) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double d =
        static_cast<double>(mesh.points[u][i]) - static_cast<double>(mesh.points[v][i]);
    sum += d * d;
  }
  return sum;
}

class Flipper {
 public:
  explicit Flipper(NormalMesh& mesh) : mesh_(mesh) {
    if (std::none_of(mesh.faces.begin(), mesh.faces.end(),
                     [this](const Face& face) { return is_sliver(face); })) {
      return;
    }
    fixed_.resize(mesh.faces.size(), 0);
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      if (repeats_vertex(mesh.faces[f])) continue;
      for (std::uint32_t i = 0; i < 3; ++i) add(f, i);
    }
  }

  std::size_t run() {
    std::size_t all = 0;
    if (faces_.empty()) return all;
    for (int round = 0; round < kMostRounds; ++round) {
      std::size_t flipped = 0;
      for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) flipped += flip(f) ? 1u : 0u;
      if (flipped == 0) break;
      all += flipped;
    }
    return all;
  }

 private:
  [[nodiscard]] Directed edge(std::uint32_t face, std::uint32_t i) const {
    return {mesh_.faces[face][i], mesh_.faces[face][(i + 1) % 3]};
  }
  void add(std::uint32_t face, std::uint32_t i) {
    const auto [at, is_new] = faces_.try_emplace(edge(face, i), face);
    if (!is_new) fixed_[face] = fixed_[at->second] = 1;  // not manifold
  }

  [[nodiscard]] bool is_sliver(const Face& face) const {
    image::RegionTriangle t{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::copy(mesh_.points[face[i]].begin(), mesh_.points[face[i]].end(), t.corners + 3 * i);
    }
    return squared_norm(image::normal_of(t)) == 0;
  }

  bool flip(std::uint32_t face) {
    const Face& sliver = mesh_.faces[face];
    if (repeats_vertex(sliver) || fixed_[face] != 0 || !is_sliver(sliver)) return false;
    std::uint32_t longest = 0;
    const auto length2 = [&](std::uint32_t i) {
      return distance2(mesh_, sliver[i], sliver[(i + 1) % 3]);
    };
    for (std::uint32_t i = 1; i < 3; ++i) {
      if (length2(i) > length2(longest)) longest = i;
    }
    const std::uint32_t u = sliver[longest];
    const std::uint32_t v = sliver[(longest + 1) % 3];
    const std::uint32_t w = sliver[(longest + 2) % 3];
    const auto beyond = faces_.find({v, u});
    if (beyond == faces_.end() || fixed_[beyond->second] != 0) return false;
    const std::uint32_t other = beyond->second;
    const Face& neighbour = mesh_.faces[other];
    const auto x = *std::find_if(neighbour.begin(), neighbour.end(),
                                 [&](std::uint32_t i) { return i != u && i != v; });
    if (x == w || faces_.contains({w, x}) || faces_.contains({x, w})) return false;
    const Face first{u, x, w};
    const Face second{x, v, w};
    if (is_sliver(first) || is_sliver(second)) return false;
    for (const std::uint32_t f : {face, other}) {
      for (std::uint32_t i = 0; i < 3; ++i) faces_.erase(edge(f, i));
    }
    mesh_.faces[face] = first;
    mesh_.faces[other] = second;
    for (const std::uint32_t f : {face, other}) {
      for (std::uint32_t i = 0; i < 3; ++i) add(f, i);
    }
    return true;
  }

  NormalMesh& mesh_;
  std::vector<char> fixed_;  // of each face: it stays
  std::map<Directed, std::uint32_t> faces_;
};

/// Makes one vertex of two that nearly coincide.
class Welder {
 public:
  explicit Welder(NormalMesh& mesh) : mesh_(mesh) {
    for (const Face& face : mesh.faces) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t u = face[i], v = face[(i + 1) % 3];
        if (u < v && distance2(mesh, u, v) < image::kThin2) short_.emplace_back(u, v);
      }
    }
    if (short_.empty()) return;
    faces_of_.resize(mesh.points.size());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      for (const std::uint32_t v : mesh.faces[f]) faces_of_[v].push_back(f);
    }
  }

  std::size_t run() {
    std::size_t welded = 0;
    for (const auto& [u, v] : short_) welded += weld(u, v) ? 1u : 0u;
    if (welded > 0) std::erase_if(mesh_.faces, repeats_vertex);
    return welded;
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> out;
    for (const std::uint32_t f : faces_of_[v]) {
      for (const std::uint32_t w : mesh_.faces[f]) {
        if (w != v && !repeats_vertex(mesh_.faces[f])) out.push_back(w);
      }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  /// As many faces as neighbours are all around a vertex; on a border there is one less.
  [[nodiscard]] bool is_on_border(std::uint32_t v, std::size_t neighbours) const {
    const auto faces =
        std::count_if(faces_of_[v].begin(), faces_of_[v].end(),
                      [this](std::uint32_t f) { return !repeats_vertex(mesh_.faces[f]); });
    return static_cast<std::size_t>(faces) != neighbours;
  }

  /// The surface stays manifold where both have two neighbours in common (link condition).
  bool weld(std::uint32_t u, std::uint32_t v) {
    const std::vector<std::uint32_t> of_u = neighbours(u), of_v = neighbours(v);
    if (!std::binary_search(of_u.begin(), of_u.end(), v)) return false;  // gone by another weld
    std::vector<std::uint32_t> common;
    std::set_intersection(of_u.begin(), of_u.end(), of_v.begin(), of_v.end(),
                          std::back_inserter(common));
    constexpr std::size_t kFaces = 2;
    constexpr std::size_t kTetrahedron = 3;  // neighbours of each of its vertices
    if (common.size() != kFaces) return false;
    if (is_on_border(u, of_u.size()) || is_on_border(v, of_v.size())) return false;
    if (of_u.size() == kTetrahedron && of_v.size() == kTetrahedron) return false;
    for (const std::uint32_t f : faces_of_[v]) {
      std::replace(mesh_.faces[f].begin(), mesh_.faces[f].end(), v, u);
      faces_of_[u].push_back(f);
    }
    faces_of_[v].clear();
    return true;
  }

  NormalMesh& mesh_;
  std::vector<Directed> short_;
  std::vector<std::vector<std::uint32_t>> faces_of_;  // of each vertex
};

}  // namespace

std::size_t remove_slivers(NormalMesh& mesh) {
  const std::size_t welded = Welder(mesh).run();
  return 2 * welded + Flipper(mesh).run();
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

#include "host_bake/mesh/check.hpp"
#include "host_bake/mesh/facing.hpp"
#include "host_bake/mesh/topology.hpp"

namespace palpate::bake {
namespace {

constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

void say(RepairReport& report, std::size_t count, const char* what) {
  if (count > 0) report.done.push_back(std::to_string(count) + " " + what);
}

void turn(Face& face) { std::swap(face[1], face[2]); }

std::size_t remove_degenerate(std::vector<Face>& faces) {
  return std::erase_if(faces, repeats_vertex);
}

/// Of the faces on the same three vertices, whichever way they run, the first one stays: a surface
/// is never lost, and what is left open or crowded by it is dealt with as any other surface.
std::size_t remove_duplicates(std::vector<Face>& faces) {
  std::vector<std::pair<Face, std::uint32_t>> keys;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    Face key = faces[f];
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, f);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<char> keep(faces.size(), 1);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first == keys[i - 1].first) keep[keys[i].second] = 0;
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (keep[f]) faces[kept++] = faces[f];
  }
  const std::size_t removed = faces.size() - kept;
  faces.resize(kept);
  return removed;
}

/// A face across an edge of exactly two faces.
struct Neighbour {
  std::uint32_t face = kNoIndex;
  bool agrees = true;  ///< runs along the edge the other way, as it should
};

std::vector<std::array<Neighbour, 3>> neighbours_of(const std::vector<Face>& faces) {
  std::vector<std::array<Neighbour, 3>> neighbours(faces.size());
  const std::vector<Side> sides = sorted_sides(faces);
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() != 2) return;
    const bool agrees = edge[0].forward != edge[1].forward;
    for (std::size_t i = 0; i < 2; ++i) {
      const Side& side = edge[i];
      const std::uint32_t start = side.forward ? side.low : side.high;
      neighbours[side.face][corner_of(faces[side.face], start)] = {edge[1 - i].face, agrees};
    }
  });
  return neighbours;
}

/// Turns faces so that neighbours agree wherever the surface is orientable; the majority of each
/// patch stays as it is.
std::size_t orient(std::vector<Face>& faces) {
  const auto neighbours = neighbours_of(faces);
  std::vector<bool> reached(faces.size()), turned(faces.size());
  std::size_t total = 0;
  for (std::uint32_t seed = 0; seed < faces.size(); ++seed) {
    if (reached[seed]) continue;
    std::vector<std::uint32_t> patch{seed};
    reached[seed] = true;
    std::size_t count = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      for (const Neighbour& next : neighbours[patch[i]]) {
        if (next.face == kNoIndex || reached[next.face]) continue;
        reached[next.face] = true;
        turned[next.face] = turned[patch[i]] == next.agrees;
        count += turned[next.face] ? 1U : 0U;
        patch.push_back(next.face);
      }
    }
    const bool invert = 2 * count > patch.size();
    for (const std::uint32_t f : patch) {
      if (turned[f] != invert) turn(faces[f]);
    }
    total += invert ? patch.size() - count : count;
  }
  return total;
}

/// Gives each fan of faces round a vertex its own copy of it (A. Gueziec, G. Taubin, F. Lazarus, W.
/// Horn, "Cutting and Stitching", 2001). Faces are in one fan where they share an edge of exactly
/// two faces that agree. Returns the copies made.
std::size_t separate_fans(Mesh& mesh) {
  Sets corners(3 * mesh.faces.size());
  const std::vector<Side> sides = sorted_sides(mesh.faces);
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() != 2 || edge[0].forward == edge[1].forward) return;
    join_corners(corners, mesh.faces, edge[0], edge[1]);
  });
  const std::size_t before = mesh.points.size();
  std::vector<char> taken(before, 0);
  std::vector<std::uint32_t> vertex_of_fan(3 * mesh.faces.size(), kNoIndex);
  for (std::uint32_t corner = 0; corner < 3 * mesh.faces.size(); ++corner) {
    std::uint32_t& vertex = mesh.faces[corner / 3][corner % 3];
    std::uint32_t& own = vertex_of_fan[corners.find(corner)];
    if (own == kNoIndex) {
      own = vertex;
      if (taken[vertex]) {
        own = static_cast<std::uint32_t>(mesh.points.size());
        const Point copy = mesh.points[vertex];
        mesh.points.push_back(copy);
      }
      taken[vertex] = 1;
    }
    vertex = own;
  }
  return mesh.points.size() - before;
}

std::size_t face_outward(Mesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh.faces);
  const Components components = components_of(mesh.faces, sides);
  const std::vector<Facing> facing = facing_of(mesh, components);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (facing[components.of_face[f]] == Facing::inward) turn(mesh.faces[f]);
  }
  return static_cast<std::size_t>(std::count(facing.begin(), facing.end(), Facing::inward));
}

std::size_t remove_unreferenced(Mesh& mesh) {
  std::vector<std::uint32_t> index(mesh.points.size(), kNoIndex);
  for (const Face& face : mesh.faces) {
    for (const std::uint32_t vertex : face) index[vertex] = 0;
  }
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (index[v] == kNoIndex) continue;
    mesh.points[kept] = mesh.points[v];
    index[v] = kept++;
  }
  const std::size_t removed = mesh.points.size() - kept;
  mesh.points.resize(kept);
  for (Face& face : mesh.faces) {
    for (std::uint32_t& vertex : face) vertex = index[vertex];
  }
  return removed;
}

}  // namespace

RepairReport repair(Mesh& mesh) {
  RepairReport report;
  say(report, remove_degenerate(mesh.faces), "degenerate faces removed");
  say(report, remove_duplicates(mesh.faces), "duplicate faces removed");
  say(report, orient(mesh.faces), "faces turned to agree with their neighbours");
  say(report, separate_fans(mesh), "copies of vertices made where sheets touch");
  say(report, face_outward(mesh), "components turned outward");
  say(report, remove_unreferenced(mesh), "unreferenced vertices removed");
  return report;
}

}  // namespace palpate::bake

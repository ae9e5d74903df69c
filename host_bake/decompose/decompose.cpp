// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/decompose.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <numeric>

#include "host_bake/decompose/patch_grower.hpp"
#include "host_bake/decompose/patch_hull.hpp"
#include "host_bake/decompose/plates.hpp"
#include "host_bake/decompose/surface_edges.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kPatchesBetweenReports = 1024;
constexpr std::uint32_t kUnlimited = std::numeric_limits<std::uint32_t>::max();

/// What the check says, by face.
struct FaceFacts {
  std::vector<char> crossing, back_open;
  std::vector<std::uint32_t> most_faces;  // of a patch that holds the face
};

FaceFacts face_facts(std::size_t faces, const CheckReport& report) {
  assert(report.face_component.size() == faces);
  FaceFacts facts{std::vector<char>(faces, 0), std::vector<char>(faces, 0), {}};
  // A face outside all components (it repeats a vertex) counts as open.
  std::vector<char> sound = report.component_closed;
  const std::vector<std::uint32_t>& component = report.face_component;
  for (const std::size_t f : report.crossing_faces) {
    facts.crossing[f] = 1;
    if (component[f] < sound.size()) sound[component[f]] = 0;
  }
  for (std::size_t f = 0; f < faces; ++f)
    facts.back_open[f] = component[f] < sound.size() && sound[component[f]] ? 0 : 1;
  for (const char open : facts.back_open)
    facts.most_faces.push_back(open ? image::kMaxOpenPatchTriangles : kUnlimited);
  return facts;
}

/// Plates by their faces' distance from the nearest edge that no patch crosses, farthest first.
std::vector<std::uint32_t> crest_order(const SurfaceEdges& edges, const Plates& plates) {
  const std::vector<std::uint32_t> distance = crest_distance(edges);
  std::vector<std::uint32_t> farthest(plates.size(), 0);
  for (std::size_t f = 0; f < distance.size(); ++f) {
    std::uint32_t& d = farthest[plates.of_face[f]];
    d = std::max(d, distance[f]);
  }
  std::vector<std::uint32_t> order(plates.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return farthest[a] != farthest[b] ? farthest[a] > farthest[b] : a < b;
  });
  return order;
}

}  // namespace

std::vector<Patch> decompose(const NormalMesh& mesh, const CheckReport& report,
                             unsigned /*threads*/, const Progress& progress) {
  const FaceFacts facts = face_facts(mesh.faces.size(), report);
  const SurfaceEdges edges = surface_edges(mesh);
  const Plates plates = make_plates(mesh, edges, facts.crossing, facts.most_faces);
  PatchGrower grower(mesh, edges, plates, facts.most_faces);

  std::vector<Patch> patches;
  std::size_t faces_done = 0;
  for (const std::uint32_t seed : crest_order(edges, plates)) {
    if (!grower.is_free(seed)) continue;
    grower.grow(seed, static_cast<std::uint32_t>(patches.size()));
    const bool solid = grower.has_area() && !grower.hull().flat();
    patches.push_back(make_patch(mesh, plates, grower.plates(), solid ? &grower.hull() : nullptr,
                                 facts.back_open[grower.faces().front()] != 0));
    faces_done += patches.back().faces.size();
    if (progress && patches.size() % kPatchesBetweenReports == 0)
      progress("decompose",
               static_cast<double>(faces_done) / static_cast<double>(mesh.faces.size()));
  }
  if (progress) progress("decompose", 1);
  return patches;
}

}  // namespace palpate::bake

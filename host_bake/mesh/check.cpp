// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "host_bake/base/error.hpp"
#include "host_bake/mesh/cracks.hpp"
#include "host_bake/mesh/crossings.hpp"
#include "host_bake/mesh/facing.hpp"
#include "host_bake/mesh/topology.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kShown = 5;  ///< places a finding names
constexpr double kTiny = 1e-3;     ///< radius of a component over that of the mesh

const char* const kByRepair = "palpate's --repair fixes it";

/// Places of one rule, as they are found.
struct Places {
  std::size_t count = 0;
  std::vector<Point> first;
  void add(const Point& p) {
    if (count++ < kShown) first.push_back(p);
  }
};

void report_places(CheckReport& report, const char* rule, Severity severity, const Places& places,
                   const char* fix) {
  if (places.count == 0) return;
  report.findings.push_back({rule, severity, places.count, places.first, fix});
}

Point middle(const Point& a, const Point& b) {
  return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

Point centre(const Mesh& mesh, const Face& f) {
  const Point &a = mesh.points[f[0]], &b = mesh.points[f[1]], &c = mesh.points[f[2]];
  return {(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3, (a[2] + b[2] + c[2]) / 3};
}

/// False where the rest of the check has no numbers to work on.
bool check_numbers(const Mesh& mesh, CheckReport& report) {
  Places infinite, out_of_range, none;
  for (const Point& p : mesh.points) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) infinite.add(p);
  }
  for (const Face& f : mesh.faces) {
    if (*std::max_element(f.begin(), f.end()) >= mesh.points.size()) out_of_range.add({});
  }
  if (mesh.faces.empty()) none.add({});
  report_places(report, "coordinate not finite", Severity::error, infinite,
                "export the mesh again");
  report_places(report, "index out of range", Severity::error, out_of_range,
                "export the mesh again");
  report_places(report, "no triangles", Severity::error, none, "export a surface");
  return report.findings.empty();
}

/// What else is wrong at a crack (vertices of several fans, open edges) goes with it.
void check_cracks(const Mesh& mesh, std::span<const Side> sides, CheckReport& report) {
  const Cracks cracks = find_cracks(mesh, sides);
  Places places;
  for (const Point& corner : cracks.corners) places.add(corner);
  report_places(report, "corners nearly coincide", Severity::error, places,
                "weld them (merge by distance) where the mesh was made");
  if (places.count > 0) report.findings.back().largest_gap_m = cracks.largest_gap_m;
}

void check_faces(const Mesh& mesh, CheckReport& report) {
  Places degenerate, zero_area, duplicate;
  std::vector<std::pair<Face, std::uint32_t>> keys;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    Face key = mesh.faces[f];
    if (repeats_vertex(key)) {
      degenerate.add(centre(mesh, key));
      continue;
    }
    if (collinear(mesh.points[key[0]], mesh.points[key[1]], mesh.points[key[2]])) {
      zero_area.add(centre(mesh, key));
    }
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, f);
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first == keys[i - 1].first) duplicate.add(centre(mesh, keys[i].first));
  }
  report_places(report, "degenerate face", Severity::repairable, degenerate, kByRepair);
  report_places(report, "duplicate face", Severity::repairable, duplicate, kByRepair);
  report_places(report, "face without area", Severity::note, zero_area, "harmless");
}

/// True where every component is a consistently oriented 2-manifold.
bool check_edges(const Mesh& mesh, std::span<const Side> sides, CheckReport& report) {
  Places boundary, crowded, inconsistent, pinched;
  Sets corners(3 * mesh.faces.size());
  for_each_edge(sides, [&](std::span<const Side> edge) {
    const Point place = middle(mesh.points[edge[0].low], mesh.points[edge[0].high]);
    if (edge.size() == 1) boundary.add(place);
    if (edge.size() > 2) crowded.add(place);
    if (edge.size() == 2 && edge[0].forward == edge[1].forward) inconsistent.add(place);
    for (const Side& side : edge.subspan(1)) join_corners(corners, mesh.faces, edge[0], side);
  });
  // A vertex is sound when its corners form one fan.
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> fan(mesh.points.size(), kNone);
  std::vector<char> counted(mesh.points.size(), 0);
  for (std::uint32_t corner = 0; corner < 3 * mesh.faces.size(); ++corner) {
    const Face& face = mesh.faces[corner / 3];
    if (repeats_vertex(face)) continue;
    const std::uint32_t vertex = face[corner % 3];
    const std::uint32_t root = corners.find(corner);
    if (fan[vertex] == kNone) fan[vertex] = root;
    if (fan[vertex] == root || counted[vertex]) continue;
    counted[vertex] = 1;
    pinched.add(mesh.points[vertex]);
  }
  report.boundary_edges = boundary.count;
  report_places(report, "non-manifold edge", Severity::repairable, crowded,
                "palpate's --repair cuts the surface into sheets there, or model it without");
  report_places(report, "non-manifold vertex", Severity::repairable, pinched, kByRepair);
  report_places(report, "inconsistent orientation", Severity::repairable, inconsistent, kByRepair);
  report_places(report, "open boundary", Severity::note, boundary,
                "only the front of an open surface is felt; close the holes to have an inside");
  return crowded.count + pinched.count + inconsistent.count == 0;
}

void check_facing(const Mesh& mesh, const Components& components, CheckReport& report) {
  Places inward, doubtful;
  const std::vector<Facing> facing = facing_of(mesh, components);
  std::vector<char> seen(facing.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::uint32_t c = components.of_face[f];
    if (c == kNoComponent || seen[c]) continue;
    seen[c] = 1;
    if (facing[c] == Facing::inward) inward.add(centre(mesh, mesh.faces[f]));
    if (facing[c] == Facing::doubtful) doubtful.add(centre(mesh, mesh.faces[f]));
  }
  report_places(report, "inward orientation", Severity::repairable, inward, kByRepair);
  report_places(report, "perhaps inward orientation", Severity::note, doubtful,
                "see that the normals of this open surface point to the side that is touched");
}

struct Box {
  Point low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};
  void add(const Point& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  [[nodiscard]] double diagonal() const {
    return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  }
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
};

void check_sizes(const Mesh& mesh, const Components& components, CheckReport& report) {
  Box whole;
  std::vector<Box> boxes(components.closed.size());
  std::vector<char> used(mesh.points.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const std::uint32_t vertex : mesh.faces[f]) {
      used[vertex] = 1;
      whole.add(mesh.points[vertex]);
      if (components.of_face[f] == kNoComponent) continue;
      boxes[components.of_face[f]].add(mesh.points[vertex]);
    }
  }
  Places tiny, unused;
  for (const Box& box : boxes) {
    if (box.diagonal() < kTiny * whole.diagonal()) tiny.add(middle(box.low, box.high));
  }
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (!used[v]) unused.add(mesh.points[v]);
  }
  report_places(report, "tiny component", Severity::note, tiny, "remove it if it is debris");
  report_places(report, "unreferenced vertex", Severity::note, unused, kByRepair);
}

void check_crossings(const Mesh& mesh, CheckReport& report) {
  const auto pairs = crossing_pairs(mesh);
  Places places;
  if (!pairs) {
    places.add(centre(mesh, mesh.faces.front()));
    return report_places(report, "too many overlapping faces", Severity::error, places,
                         "remove the copies and export the mesh again");
  }
  for (const auto& [a, b] : *pairs) {
    places.add(middle(centre(mesh, mesh.faces[a]), centre(mesh, mesh.faces[b])));
    report.crossing_faces.insert(report.crossing_faces.end(), {a, b});
  }
  report.crossings = pairs->size();
  std::sort(report.crossing_faces.begin(), report.crossing_faces.end());
  report.crossing_faces.erase(
      std::unique(report.crossing_faces.begin(), report.crossing_faces.end()),
      report.crossing_faces.end());
  report_places(report, "self-intersection", Severity::note, places,
                "baked as it is; the faces concerned stay pieces of their own");
}

}  // namespace

bool CheckReport::bakeable() const {
  return std::all_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity == Severity::note; });
}

bool CheckReport::clean() const {
  return std::all_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.rule == "open boundary"; });
}

CheckReport check(const Mesh& mesh) {
  CheckReport report;
  report.vertices = mesh.points.size();
  report.faces = mesh.faces.size();
  if (!check_numbers(mesh, report)) return report;
  const std::vector<Side> sides = sorted_sides(mesh.faces);
  check_cracks(mesh, sides, report);
  check_faces(mesh, report);
  const bool sound = check_edges(mesh, sides, report);
  Components components = components_of(mesh.faces, sides);
  // Without one orientation for each component there is no inside to speak of; repair() makes it
  // first.
  if (sound) check_facing(mesh, components, report);
  check_sizes(mesh, components, report);
  check_crossings(mesh, report);
  report.components = components.closed.size();
  report.closed_components =
      static_cast<std::size_t>(std::count(components.closed.begin(), components.closed.end(), 1));
  report.face_component = std::move(components.of_face);
  report.component_closed = std::move(components.closed);
  return report;
}

std::string describe(const Finding& finding) {
  std::string text = std::to_string(finding.count) + " x " + finding.rule;
  if (finding.largest_gap_m > 0) {
    char gap[48];
    std::snprintf(gap, sizeof gap, " (largest gap %.2g m)", finding.largest_gap_m);
    text += gap;
  }
  for (std::size_t i = 0; i < finding.first.size(); ++i) {
    const Point& p = finding.first[i];
    char place[96];
    std::snprintf(place, sizeof place, "(%.6g %.6g %.6g)", p[0], p[1], p[2]);
    text += (i == 0 ? " at " : " ") + std::string(place);
  }
  return text + (finding.count > finding.first.size() ? " ..." : "");
}

void require_bakeable(const CheckReport& report, const std::string& file, bool strict) {
  for (const Finding& finding : report.findings) {
    if (finding.severity == Severity::note) continue;
    throw InputRefused(describe(finding), file, finding.fix);
  }
  if (strict && report.crossings > 0) {
    const auto crossing =
        std::find_if(report.findings.begin(), report.findings.end(),
                     [](const Finding& f) { return f.rule == "self-intersection"; });
    throw InputRefused(describe(*crossing), file, "fix the mesh, or bake without --strict");
  }
}

}  // namespace palpate::bake

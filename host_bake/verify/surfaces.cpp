// SPDX-License-Identifier: GPL-3.0-or-later
// Levels as surfaces: each by itself, and against the original one.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <iterator>
#include <list>
#include <map>
#include <vector>

#include "host_bake/mesh/check.hpp"
#include "host_bake/metrics/vector.hpp"
#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {
namespace {

constexpr double kDeviationTolerance = 1e-9;
constexpr int kSamplesAlongEdge = 4;  // intervals

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

// Pieces have copies of their vertices: equal positions are one vertex.
Mesh mesh_of(const Evidence& evidence, std::uint32_t level) {
  Mesh mesh;
  std::map<PointF, std::uint32_t> index_of;
  for (const std::uint32_t i : alive_at(evidence.image, level)) {
    for (const image::Triangle& t : patch(evidence, evidence.image.pieces[i])) {
      Face face{};
      for (std::size_t k = 0; k < 3; ++k) {
        const PointF& p = evidence.points[i][t.vertices[k]];
        const auto [place, is_new] =
            index_of.try_emplace(p, static_cast<std::uint32_t>(mesh.points.size()));
        if (is_new) {
          const Vec3d at = vec(p);
          mesh.points.push_back({at.x, at.y, at.z});
        }
        face[k] = place->second;
      }
      mesh.faces.push_back(face);
    }
  }
  return mesh;
}

// Faults by rule, but for what a level may have as the original does.
std::map<std::string, std::size_t> faults(const CheckReport& report) {
  std::map<std::string, std::size_t> counts;
  for (const Finding& f : report.findings) {
    if (f.severity != Severity::note) counts[f.rule] = f.count;
  }
  counts["self-intersection"] = report.crossings;
  counts["boundary edge"] = report.boundary_edges;
  return counts;
}

Triangles original_triangles(const Evidence& evidence) {
  Triangles out;
  const auto at = [](const PointF& p) {
    const Vec3d v = vec(p);
    return Kernel::Point_3(v.x, v.y, v.z);
  };
  for (const std::uint32_t i : alive_at(evidence.image, 0)) {
    const auto& p = evidence.points[i];
    for (const image::Triangle& t : patch(evidence, evidence.image.pieces[i])) {
      out.emplace_back(at(p[t.vertices[0]]), at(p[t.vertices[1]]), at(p[t.vertices[2]]));
    }
  }
  return out;
}

std::string farther_than_s(const Evidence& evidence, const Tree& original, std::uint32_t index) {
  const image::Piece& piece = evidence.image.pieces[index];
  if (piece.level == 0) return {};
  const auto& p = evidence.points[index];
  for (const image::Triangle& t : patch(evidence, piece)) {
    const PointF &a = p[t.vertices[0]], &b = p[t.vertices[1]], &c = p[t.vertices[2]];
    for (int i = 0; i <= kSamplesAlongEdge; ++i) {
      for (int j = 0; j <= kSamplesAlongEdge - i; ++j) {
        const double u = static_cast<double>(i) / kSamplesAlongEdge;
        const double v = static_cast<double>(j) / kSamplesAlongEdge;
        const auto mix = [&](std::size_t k) {
          return (1 - u - v) * static_cast<double>(a[k]) + u * static_cast<double>(b[k]) +
                 v * static_cast<double>(c[k]);
        };
        const double away =
            std::sqrt(original.squared_distance(Kernel::Point_3(mix(0), mix(1), mix(2))));
        if (away > static_cast<double>(piece.surface_deviation) + kDeviationTolerance) {
          return "a point is " + std::to_string(away) + " from the original surface, s is " +
                 std::to_string(piece.surface_deviation);
        }
      }
    }
  }
  return {};
}

}  // namespace

Proof prove_levels_are_surfaces(const Evidence& evidence) {
  const std::string invariant = "levels are oriented manifolds without new crossings";
  std::map<std::string, std::size_t> allowed;
  std::size_t levels = 0;
  for (std::uint32_t l = 0; l < evidence.image.levels.size(); ++l) {
    if (evidence.image.levels[l].free != 0) break;
    ++levels;
    auto found = faults(check(mesh_of(evidence, l)));
    if (l == 0) allowed = found;
    for (const auto& [rule, count] : found) {
      if (count > allowed[rule])
        return {invariant, false,
                "level " + std::to_string(l) + ": " + std::to_string(count) + " x " + rule};
    }
  }
  return {invariant, true, std::to_string(levels) + (levels == 1 ? " level" : " levels")};
}

Proof prove_deviation_bounds(const Evidence& evidence) {
  const std::string invariant = "s bounds how far patches are from the original surface";
  if (evidence.image.header->dropped_levels > 0) return not_provable(invariant);
  const Triangles triangles = original_triangles(evidence);
  Tree tree(triangles.begin(), triangles.end());
  tree.build();
  tree.accelerate_distance_queries();
  return prove_each(invariant, evidence.image.pieces.size(),
                    [&](std::uint32_t i) { return farther_than_s(evidence, tree, i); });
}

}  // namespace palpate::bake

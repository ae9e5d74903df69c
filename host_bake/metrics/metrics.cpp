// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/metrics.hpp"

#include <algorithm>
#include <utility>

#include "host_bake/base/parallel.hpp"
#include "host_bake/metrics/hausdorff.hpp"

namespace palpate::bake {
namespace {

// The minimum rule of Sec. 4.5, level by level.
void inherit_support_area(const std::vector<SimplifiedLevel>& levels, std::vector<float>& area) {
  std::size_t below = 0;
  for (const SimplifiedLevel& level : levels) {
    const std::size_t first = area.size();
    area.resize(first + level.mesh.points.size(), image::kMaxArea);
    for (std::size_t v = 0; v < level.vertex_of_vertex.size(); ++v) {
      float& least = area[first + level.vertex_of_vertex[v]];
      least = std::min(least, area[below + v]);
    }
    below = first;
  }
}

// Children come before their parents.
std::vector<float> nested(const Hierarchy& tree,
                          const std::vector<std::vector<float>>& deviations) {
  std::vector<float> s(tree.levels.front().pieces, 0.0f);
  for (const std::vector<float>& of_level : deviations) {
    s.insert(s.end(), of_level.begin(), of_level.end());
  }
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (const std::uint32_t c : tree.pieces[i].children) s[i] = std::max(s[i], s[c]);
  }
  s.resize(tree.pieces.size(), 0.0f);
  return s;
}

Sphere sphere_of(const Hierarchy& tree, const TreePiece& piece) {
  std::vector<PointF> points = hull_points(tree, piece);
  const std::vector<PointF> below = positions(tree, piece.enclosing);
  points.insert(points.end(), below.begin(), below.end());
  return bounding_sphere(points);
}

}  // namespace

Metrics measure(const Hierarchy& tree, const std::vector<SimplifiedLevel>& levels,
                const std::vector<std::vector<float>>& deviations, std::vector<float> support_area,
                const Progress& progress) {
  const auto report = [&](double share) {
    if (progress) progress("metrics", share);
  };
  Metrics metrics;
  metrics.support_area = std::move(support_area);
  inherit_support_area(levels, metrics.support_area);
  metrics.surface_deviation = nested(tree, deviations);
  metrics.spheres.resize(tree.pieces.size());
  parallel_for(tree.pieces.size(),
               [&](std::size_t i) { metrics.spheres[i] = sphere_of(tree, tree.pieces[i]); });
  report(0.3);
  metrics.hausdorff = hausdorff_bounds(tree);
  report(0.7);
  metrics.culling = culling_bounds(tree, metrics.hausdorff);
  report(1);
  return metrics;
}

}  // namespace palpate::bake

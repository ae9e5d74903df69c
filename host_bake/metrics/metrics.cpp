// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/metrics.hpp"

#include <utility>

#include "host_bake/base/parallel.hpp"
#include "host_bake/metrics/hausdorff.hpp"

namespace palpate::bake {

Metrics measure(const Hierarchy& tree, std::vector<float> support_area, const Progress& progress) {
  Metrics metrics;
  metrics.support_area = std::move(support_area);
  metrics.spheres.resize(tree.pieces.size());
  parallel_for(tree.pieces.size(), [&](std::size_t i) {
    metrics.spheres[i] = bounding_sphere(hull_points(tree, tree.pieces[i]));
  });
  if (progress) progress("metrics", 0.5);
  metrics.hausdorff = hausdorff_bounds(tree);
  if (progress) progress("metrics", 1);
  return metrics;
}

}  // namespace palpate::bake

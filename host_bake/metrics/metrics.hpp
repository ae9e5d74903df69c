// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured on a finished hierarchy (Sec. 4.5).
#pragma once

#include <vector>

#include "host_bake/base/error.hpp"
#include "host_bake/hierarchy/hierarchy.hpp"
#include "host_bake/metrics/culling.hpp"
#include "host_bake/metrics/sphere.hpp"

namespace palpate::bake {

/// For radius 1.
struct Metrics {
  std::vector<Sphere> spheres;  ///< of each piece's hull and of all that is below the piece
  std::vector<float>
      surface_deviation;              ///< s of each piece; 0 on free levels, which have no metric
  std::vector<float> hausdorff;       ///< h of each piece
  std::vector<CullingBound> culling;  ///< of each piece
  std::vector<float> support_area;    ///< D of each point of the hierarchy
};

/// Measures a tree made of a mesh and these simplified levels. D of a vertex is the least D of the
/// original vertices that were collapsed into it; s of a piece is at least that of its children.
/// @param deviations    [levels][patches] s of each patch by itself
/// @param support_area  D of each vertex of the mesh
/// Parallel; the same whatever the number of threads. Stage "metrics".
Metrics measure(const Hierarchy& tree, const std::vector<SimplifiedLevel>& levels,
                const std::vector<std::vector<float>>& deviations, std::vector<float> support_area,
                const Progress& progress);

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured on a finished hierarchy (Sec. 4.5).
#pragma once

#include <vector>

#include "host_bake/base/error.hpp"
#include "host_bake/hierarchy/hierarchy.hpp"
#include "host_bake/metrics/sphere.hpp"

namespace palpate::bake {

/// For radius 1.
struct Metrics {
  std::vector<Sphere> spheres;      ///< of each piece's hull
  std::vector<float> hausdorff;     ///< h of each piece
  std::vector<float> support_area;  ///< D of each point of the hierarchy
};

/// Measures the tree. @param support_area  D of each of tree.points (support_areas(), and what
/// simplification makes of it) Parallel; the same whatever the number of threads. Stage "metrics".
Metrics measure(const Hierarchy& tree, std::vector<float> support_area, const Progress& progress);

}  // namespace palpate::bake

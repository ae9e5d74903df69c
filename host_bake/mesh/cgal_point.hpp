// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh's points as CGAL's exact predicates take them.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// The same three doubles. O(1)
inline CgalKernel::Point_3 to_cgal(const Point& p) { return {p[0], p[1], p[2]}; }

}  // namespace palpate::bake

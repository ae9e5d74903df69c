// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles without a normal.
#pragma once

#include <cstddef>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// Takes away triangles whose normal is rounding (image::normal_of() is 0), so that every edge
/// beside them has two normals. The surface moves by at most 1e-6.
/// - Needles: two vertices that nearly coincide become one, and the faces between them go.
/// - Then flips the longest edge of every sliver whose neighbour there forms two proper triangles
///   with its third corner: a vertex on an edge becomes one of its ends.
/// Borders and what would not stay manifold are left alone. Faces change their numbers, and what
/// crossed a neighbour before may not any more.
/// @return how many there were. O(n log n)
std::size_t remove_slivers(NormalMesh& mesh);

}  // namespace palpate::bake

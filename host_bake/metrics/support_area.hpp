// SPDX-License-Identifier: GPL-3.0-or-later
// Support area D (Sec. 4.5) and resolution of the original surface (Sec. 4.1).
#pragma once

#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// Unit normals of the vertices: incident faces' normals weighted with their angle at the vertex
/// (Thuermer and Wuethrich 1998), which does not depend on how the faces are divided. Zero where
/// they cancel out, and for vertices without faces.
std::vector<Vec3d> vertex_normals(const NormalMesh& mesh);

/// Least share of the mean area of faces around a vertex that a support area can have.
inline constexpr double kLeastSupportShare = 0.01;

/// Support area D of every vertex, for radius 1: the area, projected onto the vertex's tangent
/// plane, of the parts of its incident faces that lie within delta of the vertex along its normal
/// N.
///
/// This is the strict reading of Sec. 4.5 (incident faces only). Two choices where the paper is
/// silent: the normal cone is the open half space about N (a face turned by 90 degrees or more from
/// N does not support along N; up to there the projection fades it out by itself), and a face is
/// cut off at delta instead of left out, so that D depends on delta continuously. D is at least
/// kLeastSupportShare of the mean over all vertices of their faces' unprojected area: sharp tips
/// would have zero, and D divides in eq. 7.
/// @param delta_rel  relative to the radius, > 0
std::vector<float> support_areas(const NormalMesh& mesh, const std::vector<Vec3d>& normals,
                                 double delta_rel);

/// Largest resolution of an edge (eq. 1), for radius 1: the inverse of the least projected edge
/// length. Nothing has been collapsed on level 0, so N is the mean of the end points' normals
/// instead of the collapsed vertex's normal. Finite: projected lengths count as at least 1e-7, what
/// float coordinates resolve.
float finest_resolution(const NormalMesh& mesh, const std::vector<Vec3d>& normals);

}  // namespace palpate::bake

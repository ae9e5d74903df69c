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

/// Which faces Sec. 4.5 means by "nearby".
enum class SupportReading {
  one_ring,  ///< the vertex's faces
  grown,     ///< and all that are reached from them over edges within delta and the normal cone
};

/// Support area D of every vertex, for radius 1: the area, projected onto the vertex's tangent
/// plane, of the parts of nearby faces that lie within delta of the vertex along its normal N and
/// whose normals lie in its normal cone.
///
/// Three choices where the paper is silent. The normal cone is the open half space about N (a face
/// turned by 90 degrees or more from N does not support along N; up to there the projection fades
/// it out by itself). A face is cut off at delta instead of left out, so that D depends on delta
/// continuously. `grown` crosses an edge when some point of it is within delta and the face behind
/// it is in the cone. D is at least kLeastSupportShare of the mean over all vertices of their
/// faces' unprojected area: sharp tips would have zero, and D divides in eq. 7.
///
/// one_ring depends on the tessellation (it shrinks with the triangles), grown on delta alone where
/// the surface is smooth: about 2 pi delta on a sphere.
/// @param delta_rel  relative to the radius, > 0
/// Cost: one_ring O(n); grown O(n * faces within delta), about 13 ns each, parallel and the same
/// whatever the number of threads.
std::vector<float> support_areas(const NormalMesh& mesh, const std::vector<Vec3d>& normals,
                                 double delta_rel,
                                 SupportReading reading = SupportReading::one_ring);

/// Largest resolution of an edge (eq. 1), for radius 1: the inverse of the least projected edge
/// length. Nothing has been collapsed on level 0, so N is the mean of the end points' normals
/// instead of the collapsed vertex's normal. Finite: projected lengths count as at least 1e-7, what
/// float coordinates resolve.
float finest_resolution(const NormalMesh& mesh, const std::vector<Vec3d>& normals);

}  // namespace palpate::bake

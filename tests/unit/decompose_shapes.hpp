// SPDX-License-Identifier: GPL-3.0-or-later
// Procedural meshes for the tests of hulls and patches: closed, oriented outward unless said
// otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "host_bake/mesh/check.hpp"
#include "host_bake/mesh/mesh.hpp"
#include "mesh_support.hpp"

namespace palpate::test {

/// An octahedron's faces divided by n along each edge, pushed onto a sphere (then scaled): 8 n^2
/// triangles.
bake::Mesh sphere(int n, bake::Point scale = {1, 1, 1});

/// The sphere with radii 1 + height(direction).
bake::Mesh bumpy_sphere(int n, const std::function<double(const bake::Point&)>& height);

/// The half z >= 0 of the sphere, open at the equator.
bake::Mesh open_hemisphere(int n);

/// Tube of radius `tube` about a unit circle; each vertex is moved along its normal by up to
/// `noise`.
bake::Mesh torus(int around, int along, double tube, double noise, std::uint32_t seed);

/// Regular prism of 2 sides triangles on its wall and fans as its ends.
bake::Mesh cylinder(int sides);

/// Surface of unit cells; each cell wall is two triangles. Cells that meet at an edge or corner
/// only make a surface that is not manifold.
bake::Mesh voxels(const std::vector<std::array<int, 3>>& cells);

/// A block n x n wide under the surface z = height(x, y), x and y in [-1, 1], with the bottom at z
/// = -1.
bake::Mesh block(int n, const std::function<double(double, double)>& height);

using bake::testing::together;

/// Cast to float, not moved or scaled.
bake::NormalMesh as_is(const bake::Mesh& mesh);

/// A report that calls every face part of one closed component without crossings.
bake::CheckReport sound_report(const bake::NormalMesh& mesh);

}  // namespace palpate::test

// SPDX-License-Identifier: GPL-3.0-or-later
// What an image says of the surface beside its triangles: vertices with their normals, convex
// edges, cones of normals.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "rt_core/image/region_format.hpp"

namespace palpate::bake {

struct SurfaceParts {
  std::vector<image::SurfaceVertex> vertices;
  std::vector<image::SurfaceNormal> normals;
  std::vector<std::uint32_t> edges;
  std::vector<image::SurfaceRun> runs;  ///< of each region
  std::vector<image::TriangleVertices> triangle_vertices;
};

/// @param triangles  in the order of the image, their sources faces of the mesh; linked
/// @param regions    how many
/// @param crossing_faces  of the mesh: their vertices have no pseudonormal
/// Vertices of the mesh are vertices here: copies at one place, which keep surfaces apart that
/// touch, stay apart. Throws InputRefused where a limit of the format is passed. Deterministic,
/// also across numbers of threads. O(n log n) for bounded valence
SurfaceParts surface_parts(const NormalMesh& mesh, std::span<const image::RegionTriangle> triangles,
                           std::size_t regions, std::span<const std::size_t> crossing_faces);

/// Sets the cone of the normals of each region's faces. O(triangles)
void set_normal_cones(std::span<const image::RegionTriangle> triangles,
                      std::span<image::SurfaceRun> regions);

}  // namespace palpate::bake

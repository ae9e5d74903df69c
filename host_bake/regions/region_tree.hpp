// SPDX-License-Identifier: GPL-3.0-or-later
// The region engine's sections of an image: wide tree, triangles, regions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "host_bake/regions/partition.hpp"
#include "host_bake/regions/surface_parts.hpp"
#include "rt_core/image/region_format.hpp"

namespace palpate::bake {

struct RegionTree {
  std::vector<image::RegionNode> nodes;
  std::vector<image::RegionTriangle> triangles;
  std::vector<image::Region> regions;
  SurfaceParts surface;
};

/// Builds the tree: the mesh is divided into regions and groups (partition.hpp), the binary tree is
/// folded into nodes of up to sixteen children, the largest opened first, and every child gets a
/// fitted box. The root is never a region itself, so that every region has a parent that holds its
/// box.
///
/// @param crossing_faces  of the mesh, by index: what is inside is not told by them
/// RegionTriangle::piece is left kNone: pack() knows the image's pieces. Deterministic, also across
/// numbers of threads. Throws InputRefused where a limit of the format is passed. O(n log^2 n).
RegionTree build_regions(const NormalMesh& mesh, const RegionOptions& options,
                         std::span<const std::size_t> crossing_faces = {});

}  // namespace palpate::bake

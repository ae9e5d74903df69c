// SPDX-License-Identifier: GPL-3.0-or-later
// Divides a surface in two, again and again: first into regions, then into groups of at most
// sixteen triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "rt_core/image/region_format.hpp"

namespace palpate::bake {

struct RegionOptions {
  /// Regions larger than this are divided; relative to the object's radius. Needles side by side
  /// are not, where they are no wider: triangles longer than a region is wide, and so narrow that
  /// two lie side by side within one.
  double radius = 0.06;
  /// Regions in which a part of the surface turns away from the mean normal by more than the angle
  /// of this cosine are divided by normal: two opposite walls must not share a region, or the
  /// nearer one hides the other.
  double cosine = 0.2;
  /// So are those whose normals fall into two groups, the means of which are farther apart than the
  /// angle of this cosine: the least distance of one says nothing of the other
  /// (rt_core/geometry/directions.hpp). Above zero, so that walls at a right angle are two whatever
  /// rounding says.
  double walls_cosine = 0.1;
  /// ... unless smaller than this share of `radius`: roughness below it is one feature.
  double least_share = 0.25;
};

/// Regions for contacts within delta_rel, which is relative to the object's radius, above zero: a
/// little larger than a contact, for two balls of radius 1 that touch are within delta in a radius
/// of sqrt(delta). Smaller ones cost time, larger ones tell less
/// of where they are near. Between .03 and .25 whatever delta_rel. O(1)
RegionOptions region_options(double delta_rel);

/// A binary tree over runs of `faces`; node 0 is the root, children follow their parent.
struct Partition {
  struct Node {
    std::uint32_t first = 0;  ///< into faces
    std::uint32_t count = 0;
    std::uint32_t child = 0;  ///< the first of two; 0: a group, not divided further
    bool region = false;      ///< a region's root
  };
  static bool is_group(const Node& n) { return n.child == 0; }  ///< at most sixteen triangles

  std::vector<std::uint32_t> faces;  ///< a permutation of the mesh's
  std::vector<Node> nodes;
};

/// What is larger than a region is divided in the middle of the longest principal axis of the
/// triangles' centres. Needles alone, as CAD models have them, are divided by normal first, and
/// stay together side by side as long as they are no wider than a region. Regions are divided at a
/// multiple of sixteen near the middle, so that groups are full, across that of eight directions
/// along the patch which leaves parts with the shortest diagonals. Every group is in exactly one
/// region. Deterministic. O(n log^2 n).
Partition divide(const NormalMesh& mesh, const RegionOptions& options);

}  // namespace palpate::bake

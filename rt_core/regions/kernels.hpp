// SPDX-License-Identifier: Apache-2.0
// The inner loops of the region engine, for the widest instruction set at hand: one box against the
// boxes of a node, sixteen pairs of triangles, and where sixteen triangles lie in a grid.
//
// Every table gives the same bits (simd.hpp). They are chosen once, when an engine is made.
#pragma once

#include <cstdint>
#include <limits>

#include "rt_core/geometry/pose.hpp"
#include "rt_core/image/region_format.hpp"

namespace palpate::regions {

inline constexpr std::uint32_t kBatch = image::kRegionWidth;  ///< pairs of triangles at once

/// An oriented box in the coordinates of its image. Columns 0 to 2 are the axes, 3 the centre.
struct alignas(16) Box {
  float x[4];
  float y[4];
  float z[4];
  float half[4];  ///< [3] unused
};

/// Maps image coordinates of one body to those of the other: scale * rotation * x + translation.
struct Transform {
  float rotation[9];  ///< row by row
  float translation[3];
  float scale;
};

/// Pairs of triangles by their corners, component by component, in coordinates near the pair:
/// what witnesses() is asked for.
struct TriangleLanes {
  alignas(64) float a[9][kBatch];  ///< corner, then axis
  alignas(64) float b[9][kBatch];
};

/// Closest points of pairs of triangles, in the coordinates of the lanes.
struct WitnessLanes {
  alignas(64) float on_a[3][kBatch];
  alignas(64) float apart[3][kBatch];  ///< from the point on b to the point on a
  std::uint32_t crossing;              ///< bit i: an edge of one pierces the other
};

/// Working memory of one call at a time, about 10 KB; needs no initialisation.
struct KernelScratch {
  TriangleLanes lanes;
  alignas(64) float rows[112][kBatch];
};

/// Whether test_boxes() is asked which of the boxes that are near are nearer.
enum class Order : std::uint8_t { any, by_distance };

/// What test_boxes() says of the boxes of a node, and of those of earlier nodes.
struct BoxTest {
  BoxTest() noexcept {
    for (float& least : passed) least = std::numeric_limits<float>::max();
  }
  alignas(64) float squared[kBatch] = {};       ///< bounds
  alignas(64) std::int32_t place[kBatch] = {};  ///< of those near: how many near are farther; only
                                                ///< by_distance
  alignas(
      64) float passed[kBatch];  ///< least bounds of what was not near in any call, lane by lane
};

struct Kernels {
  const char* name;

  /// Bounds from below, squared, of the distances of a box from the boxes of a node: both boxes are
  /// projected on the axes of both; gaps along three orthogonal axes add by squares (separating
  /// axes, Gottschalk, Lin and Manocha 1996, without the crossed ones). Rounding: the root is too
  /// large by at most 1e-6 of the farther box's distance from the origin. Fills all lanes; those
  /// beyond the last child repeat the first. Of boxes that overlap the nearer is the one whose
  /// centre is; of two as near to some 2e-6 the later.
  /// @param course  the bounds hold for the box and for all its places on this way, which is in the
  ///                node's coordinates; the room that it sweeps is bounded on the same axes
  /// @param unit2  squares of lengths in the node's image times this are in the unit of the bounds
  /// @param below  squared, in the unit of the bounds; nearer boxes are near
  /// @param order  by_distance: out.place of those that are near is set, else it stays as it was
  /// @return bit i set where child i is near
  std::uint32_t (*test_boxes)(const Box& box, const Transform& to_node, Vec3f course,
                              const image::RegionNode& node, float unit2, float below, Order order,
                              BoxTest& out) noexcept;

  /// Squared distances of kBatch pairs of triangles, in the unit of b's image; crossing pairs have
  /// 0 and their bit in the result. All features: 9 pairs of edges, 6 corners and faces, 6
  /// piercings; slivers, segments and points are triangles too. The root is right to 1e-6.
  std::uint32_t (*triangle_distances)(const image::RegionTriangle* const (&a)[kBatch],
                                      const image::RegionTriangle* const (&b)[kBatch],
                                      const Transform& a_to_b, KernelScratch& scratch,
                                      float (&out_squared)[kBatch]) noexcept;

  /// The same, and the way from b's closest point to a's, in the coordinates of b's image; of
  /// crossing pairs any. The distances have the bits of triangle_distances().
  std::uint32_t (*triangle_ways)(const image::RegionTriangle* const (&a)[kBatch],
                                 const image::RegionTriangle* const (&b)[kBatch],
                                 const Transform& a_to_b, KernelScratch& scratch,
                                 float (&out_squared)[kBatch],
                                 float (&out_apart)[3][kBatch]) noexcept;

  /// The same distances, and bounds from below, squared, of those while a goes a course, which is
  /// in the coordinates of b's image: how far the pairs are apart along their ways now, less what
  /// of the course goes against these; 0 where they cross. The root is too large by at most 1e-6.
  std::uint32_t (*triangle_courses)(const image::RegionTriangle* const (&a)[kBatch],
                                    const image::RegionTriangle* const (&b)[kBatch],
                                    const Transform& a_to_b, Vec3f course, KernelScratch& scratch,
                                    float (&out_squared)[kBatch],
                                    float (&out_least)[kBatch]) noexcept;

  /// How far kBatch pairs of triangles are apart along a direction, at which every a lies beyond b;
  /// below 0 where they overlap along it. In the unit of b's image, as the direction of length 1,
  /// which is in its coordinates. No pair is nearer than that.
  void (*separations)(const image::RegionTriangle* const (&a)[kBatch],
                      const image::RegionTriangle* const (&b)[kBatch], const Transform& a_to_b,
                      Vec3f along, float (&out)[kBatch]) noexcept;

  /// Closest points of the kBatch pairs in scratch.lanes; where a pair crosses, of its edges and
  /// corners.
  void (*witnesses)(KernelScratch& scratch, WitnessLanes& out) noexcept;

  /// Squared distances of a point from the boxes of a node, 0 inside, too large by at most 1e-6.
  /// @return bit i: box i is nearer than the root of `below`
  std::uint32_t (*point_boxes)(Vec3f point, const image::RegionNode& node, float below,
                               float (&out_squared)[kBatch]) noexcept;
};

/// The widest table that this processor and its operating system can run. Asks the processor: not
/// for the real-time loop.
const Kernels& best_kernels() noexcept;

inline constexpr std::uint32_t kMostKernels = 4;

/// All tables that can run here, narrowest first; for tests and benchmarks.
/// @return how many of out are set, at least one
std::uint32_t all_kernels(const Kernels* (&out)[kMostKernels]) noexcept;

// What each translation unit provides; null where the build or the target has no such instructions.
const Kernels* kernels_scalar() noexcept;
const Kernels* kernels_base() noexcept;
const Kernels* kernels_avx2() noexcept;
const Kernels* kernels_avx512() noexcept;

}  // namespace palpate::regions

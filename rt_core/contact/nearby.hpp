// SPDX-License-Identifier: Apache-2.0
// Triangles of a surface near a point or a segment: a traversal of the wide tree (BVH) of its
// image.
#pragma once

#include <cstdint>

#include "rt_core/base/assert.hpp"
#include "rt_core/base/pace.hpp"
#include "rt_core/contact/surface.hpp"
#include "rt_core/regions/kernels.hpp"

namespace palpate::contact {

/// A body as the target of queries.
struct Target {
  Surface surface;
  const regions::Kernels* kernels = nullptr;
};

/// Work units: a node is one, and so are this many triangles.
inline constexpr std::uint32_t kTrianglesPerUnit = 4;

/// Calls visit(triangle) for every triangle whose box is no farther than the radius, nearer boxes
/// first below one node. `radius` is read again before every node, so that visit may shrink it.
/// @param boxes   (node, below, squared): the node's children that are nearer than the root of
///                `below`, as Kernels::point_boxes() has it; in image coordinates
/// @param extent  in image coordinates: nothing asked for is farther from the origin
/// @param radius  in the surface's units
/// Cost: a unit for each node and for kTrianglesPerUnit triangles. No recursion.
template <class Boxes, class Visit>
[[gnu::noinline]] void traverse(const Target& target, Pace& pace, Boxes boxes, double extent,
                                const double& radius, Visit visit) noexcept {
  constexpr double kRounding = 2e-6;
  struct Level {
    std::uint32_t first;  // child of its node
    std::uint32_t near;   // bit i: child i is still to be seen
    float squared[regions::kBatch];
  };
  Level levels[image::kMaxRegionDepth];
  const ImageView& image = *target.surface.image;
  const double per_unit = 1 / target.surface.scale;
  const double slack = kRounding * (1 + extent);
  const auto limit = [&] {
    const double reach = per_unit * radius + slack;
    return static_cast<float>(reach * reach);
  };
  std::uint32_t depth = 0;
  std::uint32_t node = 0;
  for (;;) {
    const image::RegionNode& at = image.region_nodes[node];
    PALPATE_ASSERT(depth < image::kMaxRegionDepth);
    Level& level = levels[depth];
    level.first = at.first;
    level.near = boxes(at, limit(), level.squared);
    pace.charge(1);
    if (at.leaf != 0) {
      std::uint32_t seen = 0;
      for (std::uint32_t near = level.near; near != 0; near &= near - 1, ++seen) {
        const auto slot = static_cast<std::uint32_t>(__builtin_ctz(near));
        if (level.squared[slot] <= limit()) visit(at.first + slot);
      }
      pace.charge(seen / kTrianglesPerUnit);
    } else {
      ++depth;
    }
    // Up to the next level with a child that may be near; the nearest of them.
    for (;;) {
      if (depth == 0) return;
      Level& above = levels[depth - 1];
      const float below = limit();
      std::uint32_t nearest = regions::kBatch;
      for (std::uint32_t near = above.near; near != 0; near &= near - 1) {
        const auto slot = static_cast<std::uint32_t>(__builtin_ctz(near));
        if (above.squared[slot] > below) {
          above.near &= ~(1u << slot);
        } else if (nearest == regions::kBatch || above.squared[slot] < above.squared[nearest]) {
          nearest = slot;
        }
      }
      if (nearest < regions::kBatch) {
        above.near &= ~(1u << nearest);
        node = above.first + nearest;
        break;
      }
      --depth;
    }
  }
}

/// traverse() for what is near a point.
/// @param x  in the surface's coordinates
template <class Visit>
void for_each_near(const Target& target, Pace& pace, Vec3d x, const double& radius,
                   Visit visit) noexcept {
  const Vec3d in_image = (1 / target.surface.scale) * x;
  const Vec3f point = vec_cast<float>(in_image);
  const auto boxes = [&](const image::RegionNode& node, float below,
                         float(&squared)[regions::kBatch]) {
    return target.kernels->point_boxes(point, node, below, squared);
  };
  traverse(target, pace, boxes, norm(in_image), radius, visit);
}

/// A segment as a box of no width, in image coordinates.
regions::Box box_of_segment(Vec3d from, Vec3d to) noexcept;
/// As Kernels::point_boxes(), of a box.
std::uint32_t near_boxes(const regions::Kernels& kernels, const regions::Box& box,
                         const image::RegionNode& node, float below,
                         float (&out_squared)[regions::kBatch]) noexcept;

/// traverse() for what is near a segment.
/// @param from, to  in the surface's coordinates
template <class Visit>
void for_each_near_segment(const Target& target, Pace& pace, Vec3d from, Vec3d to,
                           const double& radius, Visit visit) noexcept {
  const double per_unit = 1 / target.surface.scale;
  const regions::Box box = box_of_segment(per_unit * from, per_unit * to);
  const auto boxes = [&](const image::RegionNode& node, float below,
                         float(&squared)[regions::kBatch]) {
    return near_boxes(*target.kernels, box, node, below, squared);
  };
  traverse(target, pace, boxes, per_unit * (norm(from) + norm(to)), radius, visit);
}

/// A point's signed distance from a surface: negative inside.
struct SignedDistance {
  Foot foot;         ///< foot.triangle is kNone where nothing is within the limit
  double value = 0;  ///< meaningful where there is a foot

  /// Whether another foot is nearer; of equally near ones that of the first triangle is.
  [[nodiscard]] bool is_nearer(const Foot& other) const noexcept {
    return foot.triangle == image::kNone || other.squared < foot.squared ||
           (other.squared == foot.squared && other.triangle < foot.triangle);
  }
};

/// The distance of x from its foot, the nearest of all: negative inside. Behind an open surface
/// that is only up to open_depth(), and nowhere where the foot is on a border.
double signed_by(const Surface& surface, const Foot& foot, Vec3d x) noexcept;

/// No more than a signed distance, and changes no faster than points move. Signed distances from
/// closed surfaces are that themselves; about an open one the sign may change anywhere.
inline double lipschitz_bound(const Surface& surface, double signed_distance) noexcept {
  if (!is_open(surface)) return signed_distance;
  return (signed_distance < 0 ? -signed_distance : signed_distance) - 2 * open_depth(surface);
}

/// @param hint   a triangle that may be near, or kNone
/// @param limit  farther surfaces are of no interest
SignedDistance signed_distance(const Target& target, Pace& pace, Vec3d x, std::uint32_t hint,
                               double limit) noexcept;

}  // namespace palpate::contact

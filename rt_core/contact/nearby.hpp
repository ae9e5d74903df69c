// SPDX-License-Identifier: Apache-2.0
// What of a surface is near a point or a segment: traversals of the wide tree (BVH) of its image,
// and looks into its proximity grid.
#pragma once

#include <cstddef>
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

/// What float rounding takes from boxes and cells at distance x from the origin is at most
/// (1 + x) times this, in image coordinates.
inline constexpr double kFloatRounding = 2e-6;
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
  struct Level {
    std::uint32_t first;  // child of its node
    std::uint32_t near;   // bit i: child i is still to be seen
    float squared[regions::kBatch];
  };
  Level levels[image::kMaxRegionDepth];
  const ImageView& image = *target.surface.image;
  const double per_unit = 1 / target.surface.scale;
  const double slack = kFloatRounding * (1 + extent);
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

/// @param hint  a triangle that may be near, or kNone
SignedDistance signed_distance(const Target& target, Pace& pace, Vec3d x,
                               std::uint32_t hint) noexcept;

/// A cell of an image's proximity grid, or a brick of cells that are not told apart.
struct ProximityCell {
  Vec3f centre{};              ///< in the image's coordinates
  std::uint32_t triangle = 0;  ///< the nearest to the centre
};

/// The cell in which a point lies; of points outside the grid, the outermost one. Precondition: the
/// image has a proximity grid. O(1)
/// @param x  in the image's coordinates
inline ProximityCell cell_at(const ImageView& image, Vec3f x) noexcept {
  const image::ProximityGrid& grid = *image.proximity_grid;
  const float per_cell = 1 / grid.cell;
  const auto cell_along = [&](float place, std::size_t axis) {
    const auto last = static_cast<float>(grid.bricks[axis] * image::kBrickEdge - 1);
    const float at = per_cell * (place - grid.origin[axis]);
    return static_cast<std::uint32_t>(!(at > 0) ? 0 : at < last ? at : last);
  };
  const std::uint32_t cx = cell_along(x.x, 0);
  const std::uint32_t cy = cell_along(x.y, 1);
  const std::uint32_t cz = cell_along(x.z, 2);
  constexpr std::uint32_t kEdge = image::kBrickEdge;
  const std::size_t row = cy / kEdge + std::size_t{grid.bricks[1]} * (cz / kEdge);
  const std::uint32_t named = image.proximity_bricks[cx / kEdge + grid.bricks[0] * row];
  const auto centre = [&](std::uint32_t x_of, std::uint32_t y_of, std::uint32_t z_of, float half) {
    return Vec3f{grid.origin[0] + grid.cell * (static_cast<float>(x_of) + half),
                 grid.origin[1] + grid.cell * (static_cast<float>(y_of) + half),
                 grid.origin[2] + grid.cell * (static_cast<float>(z_of) + half)};
  };
  if ((named & image::kCoarseBrick) != 0) {
    constexpr float kHalf = 0.5f * kEdge;
    return {centre(cx - cx % kEdge, cy - cy % kEdge, cz - cz % kEdge, kHalf),
            named & ~image::kCoarseBrick};
  }
  const std::uint32_t cell = cx % kEdge + kEdge * (cy % kEdge + kEdge * (cz % kEdge));
  return {centre(cx, cy, cz, 0.5f),
          image.proximity_cells[std::size_t{named} * image::kBrickCells + cell]};
}

/// A lower bound of a point's signed distance, in the surface's coordinates: that of its cell's
/// centre, less how far it is from there; outside the grid, that of the grid. O(1)
double distance_bound(const Surface& surface, Vec3d x) noexcept;

}  // namespace palpate::contact

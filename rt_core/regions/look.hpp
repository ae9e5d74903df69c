// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles that may be near, by looking up where a region's triangles lie about b.
#pragma once

#include <cstdint>

#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/near_pairs.hpp"
#include "rt_core/regions/pair_frame.hpp"

namespace palpate::regions {

/// In one call, at most.
inline constexpr std::uint32_t kMostLooks = kBatch;
/// So many looks by themselves count as one work unit, beside what it takes to measure what they
/// find. Many that are under way at once wait for memory less (survey.cpp).
inline constexpr std::uint32_t kLooksPerUnit = 4;

/// Whether b's image says what is near a place, and a's which triangles are a region's.
inline bool can_look(const PairFrame& frame) noexcept {
  return frame.b->proximity_grid != nullptr && !frame.a->region_runs.empty();
}

/// In image coordinates.
inline Vec3f centre_of(const image::RegionTriangle& t) noexcept {
  const float* c = t.corners;
  constexpr float kThird = 1.0f / 3;
  return {kThird * (c[0] + c[3] + c[6]), kThird * (c[1] + c[4] + c[7]),
          kThird * (c[2] + c[5] + c[8])};
}

/// Whether a triangle is so long that its centre does not tell where it is, in cells of the grid
/// that it is looked up in or named by.
/// @param cell  in the coordinates of the triangle's image
bool is_long(const image::RegionTriangle& t, float cell) noexcept;

/// A place in the image coordinates of one body in those of the other.
inline Vec3f at_place(const Transform& m, Vec3f p) noexcept {
  const float* r = m.rotation;
  return {m.scale * (r[0] * p.x + r[1] * p.y + r[2] * p.z) + m.translation[0],
          m.scale * (r[3] * p.x + r[4] * p.y + r[5] * p.z) + m.translation[1],
          m.scale * (r[6] * p.x + r[7] * p.y + r[8] * p.z) + m.translation[2]};
}

/// The triangle of b that its proximity grid names at a place in the coordinates of b's image.
/// Precondition: can_look(frame). O(1)
std::uint32_t near_place(const PairFrame& frame, Vec3f place) noexcept;

/// Triangles of a that are looked from, each with the triangle of b that b's proximity grid names
/// where its centre lies (closest point transforms: Mauch 2000); or some other place of it, by the
/// number of the look, where it is several cells long, as those of CAD models are. Distances are
/// not measured.
///
/// A look takes four reads of memory, each from where the one before has said, and no arithmetic to
/// speak of, where a dive into both trees takes seven work units; and it finds what is near as the
/// grid's cells are fine.
struct Looks {
  std::uint32_t count = 0;
  std::uint32_t a[kMostLooks];          ///< into a's region_triangles
  std::uint32_t b[kMostLooks];          ///< into b's, once all steps are done
  const std::uint32_t* at[kMostLooks];  ///< what the next step reads
  std::uint8_t in_brick[kMostLooks];    ///< and where in that, if it is a brick
  std::uint32_t number[kMostLooks];     ///< looks from one triangle by different ones lie apart

  /// Precondition: count < kMostLooks
  void add(std::uint32_t triangle, std::uint32_t look) noexcept {
    number[count] = look;
    a[count++] = triangle;
  }
  [[nodiscard]] Witness pair(std::uint32_t i) const noexcept { return {a[i], b[i], 0}; }
};

inline constexpr std::uint32_t kLookSteps = 4;

/// Each step asks for what the next one reads: where others' steps come in between, no one waits.
/// @param step  0 to kLookSteps - 1, in that order
/// @param looks  none, too
/// Precondition: can_look(frame). O(kMostLooks)
void look_step(const Kernels& kernels, const PairFrame& frame, std::uint32_t step,
               Looks& looks) noexcept;

/// All steps, one after the other. Precondition and cost: look_step().
void look_from(const Kernels& kernels, const PairFrame& frame, Looks& looks) noexcept;

/// Adds looks from triangles that are spread over a region.
/// @param from   number of the first look; those that follow each other lie apart
/// @param count  so many more that `out` has room for them
/// @param out    before any step
/// Precondition: can_look(frame). O(count)
void look_over(const PairFrame& frame, std::uint32_t region, std::uint32_t from,
               std::uint32_t count, Looks& out) noexcept;

/// Looks from a triangle of each of sixteen regions that lie apart, or of all where there are
/// fewer.
/// @param out  without any yet
/// Precondition: can_look(frame). O(1)
void look_everywhere(const PairFrame& frame, Looks& out) noexcept;

/// Adds looks from the triangles on both sides of one of the region's: neighbours in a run are
/// neighbours on the surface. Fewer than `count` where the region has no more.
/// @param triangle  of a, not looked from itself
/// @param count     so many more that `out` has room for them
/// @param out       before any step
/// Precondition: can_look(frame). O(count)
void look_beside(const PairFrame& frame, std::uint32_t region, std::uint32_t triangle,
                 std::uint32_t count, Looks& out) noexcept;

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
// The least distance of one region of a from the whole of b, or bounds of it.
#pragma once

#include <cstdint>
#include <limits>

#include "rt_core/base/pace.hpp"
#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/near_pairs.hpp"
#include "rt_core/regions/pair_frame.hpp"

namespace palpate::regions {

/// Work units of one batch of triangle pairs; one box against the boxes of a node is one unit.
inline constexpr std::uint64_t kBatchUnits = 8;

/// What a search knows of a region. `best` is an upper bound where known.
struct Bounds {
  Witness best;
  float rest = 0;        ///< proved for all pairs but those kept, all along the course, rounding
                         ///< subtracted; >= 0
  bool complete = true;  ///< false: the search was ended before it had seen everything
  bool crowded = false;  ///< ended because more is near along the course than there is room for
};

/// Two children (pair_frame.hpp) that may hold something nearer.
struct Candidate {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  float squared = 0;  ///< bound for the whole course, in units
};

/// Depth first: each of two trees is descended at most kMaxRegionDepth times, each time leaving at
/// most all children but one behind.
inline constexpr std::uint32_t kMaxCandidates =
    2 * image::kMaxRegionDepth * image::kRegionWidth + 1;

/// Working memory of one search at a time; needs no initialisation.
struct SearchScratch {
  KernelScratch kernel;
  NearPairs near;  ///< of the last search(), nearest first: the least of each on the course
  Candidate stack[kMaxCandidates];
  std::uint32_t batch_a[kBatch];
  std::uint32_t batch_b[kBatch];
  float batch_squared[kBatch];
  std::uint32_t batch_of[kBatch];  ///< the callers': which active region each is of
};

/// Which way a pair of triangles is apart.
struct Way {
  Vec3f along{};  ///< from b's closest point to a's, of length 1, in the coordinates of b's image
  std::uint32_t a = image::kNone;  ///< not known
  std::uint32_t b = image::kNone;
  [[nodiscard]] bool is_of(const Witness& w) const noexcept {
    return w.known() && a == w.a && b == w.b;
  }
};

/// Distances at the present poses of the pairs in scratch.batch_a and batch_b, sixteen at a time.
/// @param count  1 to kBatch
void measure(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
             std::uint32_t count, float (&out_distances)[kBatch]) noexcept;

/// From b's closest points to a's, in the coordinates of b's image; of crossing pairs any.
struct WayLanes {
  float apart[3][kBatch];
};

/// The same, and how each pair is apart.
void measure_ways(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch,
                  Pace& pace, std::uint32_t count, float (&out_distances)[kBatch],
                  WayLanes& out_ways) noexcept;

/// Of one of the pairs measured; not known where it crosses.
[[nodiscard]] Way way_of(const WayLanes& ways, std::uint32_t lane,
                         const Witness& measured) noexcept;

/// How far sixteen pairs are apart, in units, along a direction of length 1 in the coordinates of
/// b's image: none is nearer. kSeparationUnits.
void separate(const Kernels& kernels, const PairFrame& frame, Pace& pace,
              const Witness (&pairs)[kBatch], Vec3f along, float (&out)[kBatch]) noexcept;
inline constexpr std::uint64_t kSeparationUnits = 2;

/// Pairs that are nearer by less than this are as near: what triangles that share the witness's
/// corner seem to be nearer by rounding.
inline constexpr float kAsNear = 0.25f * kRounding;

/// How far a search looks.
struct Reach {
  float limit = 0;   ///< distances from here on are of no interest
  float margin = 0;  ///< pairs farther than the nearest by less are kept
  Vec3f course{};    ///< of the region: what is proved holds all along it; in b's image coordinates
  float widest = kFarthest;  ///< along a course: ended where what there is no room for leaves a
                             ///< wider interval, in units
  std::uint32_t room = kNearPairs;  ///< pairs that are kept, at most
};

/// Depth-first search of both trees, nearest child first: what is not nearer than
/// min(best, limit) + margin is passed over, and the pairs that are nearer are kept in
/// scratch.near.
///
/// @param region   of a
/// @param witness  the best known; its distance at the present poses
/// While the region goes its course, not turning, no pair of it is nearer than it is kept with, or
/// if it is not kept, than `rest`. Complete: rest >= min(best, limit) + margin - kRounding, or the
/// kept pairs are all that there is room for, and rest is no less than their distances, less
/// kRounding; best is exact. Ended before: rest and best still hold. Crowded: best does.
/// Cost: the budget, or all pairs of boxes nearer than the answer. No allocation, no recursion.
Bounds search(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
              std::uint32_t region, const Witness& witness, const Reach& reach) noexcept;

}  // namespace palpate::regions

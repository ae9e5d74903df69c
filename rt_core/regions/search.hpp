// SPDX-License-Identifier: Apache-2.0
// The least distance of one region of a from the whole of b, or bounds of it.
#pragma once

#include <cstdint>
#include <limits>

#include "rt_core/base/pace.hpp"
#include "rt_core/regions/crossing_list.hpp"
#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/near_pairs.hpp"
#include "rt_core/regions/pair_frame.hpp"

namespace palpate::regions {

/// Work units of one batch of triangle pairs; one box against the boxes of a node is one unit.
inline constexpr std::uint64_t kBatchUnits = 8;
/// The clock is read after this many units: with what is done in one go, 40 at most.
inline constexpr std::uint64_t kUnitsPerReading = 30;

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

/// A pair of triangles that an active region's look has met, before it is measured.
struct Sight {
  std::uint32_t of = 0;  ///< which active region
  Witness pair;          ///< no nearer than its distance
};
inline constexpr std::uint32_t kSights = kBatch * kBatch;  ///< of sixteen regions

/// Working memory of one search at a time; needs no initialisation.
struct SearchScratch {
  KernelScratch kernel;
  NearPairs near;  ///< of the last search(), nearest first: the least of each on the course
  Candidate stack[kMaxCandidates];
  std::uint32_t batch_a[kBatch];
  std::uint32_t batch_b[kBatch];
  float batch_squared[kBatch];
  std::uint32_t batch_of[kBatch];  ///< the callers': which active region each is of
  Sight sights[kSights];           ///< likewise
};

/// What a search that was ended early has not looked at, and what it knows of the rest: each pair
/// of the region is below one of `stack`, in `batch`, in `near`, or was at least `seen` apart.
struct Remainder {
  float seen = 0;             ///< in units, as the distances of `near`
  std::uint32_t size = 0;     ///< of stack
  std::uint32_t pending = 0;  ///< of batch
  Candidate stack[kMaxCandidates];
  Candidate batch[kBatch];  ///< pairs of triangles
  NearPairs near;
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

/// How near sixteen pairs may be, in units: none is nearer than that, and hardly any of triangles
/// that face each other is much farther (Kernels::triangle_bounds). kBoundUnits.
/// @param a, b  into the bodies' region_triangles
void bound(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
           const std::uint32_t (&a)[kBatch], const std::uint32_t (&b)[kBatch],
           float (&out)[kBatch]) noexcept;
inline constexpr std::uint64_t kBoundUnits = 2;

/// Pairs that are nearer by less than this are as near: what triangles that share the witness's
/// corner seem to be nearer by rounding.
inline constexpr float kAsNear = 0.25f * kRounding;

/// Of each neighbour of a triangle of a that is in another region the nearest pair measured.
struct Beside {
  Witness pairs[3];
  std::uint32_t count = 0;
};

/// Goes from a witness to a neighbour of either triangle, or of both, while that is nearer; within
/// the witness's region of a. Where one look along the witness's way tells that none is nearer by
/// more than kAsNear, that is all: kSeparationUnits. Else at most kMaxClimb batches and as many
/// looks.
/// @param way         of the witness, where it is known
/// @param out_beside  what the last batch has measured beyond the region's border; may be null
inline constexpr std::uint32_t kMaxClimb = 3;
void climb(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
           Witness& witness, Way way = {}, Beside* out_beside = nullptr) noexcept;

/// A pair of triangles that may be near, in a part of a region: the box of one of its leaves, and
/// down the other tree from nearest child to nearest child. Its distance is not measured.
/// @param which  any number; those that follow each other lie apart
/// Cost: a unit for each level of b's tree and one.
Witness dive(const Kernels& kernels, const PairFrame& frame, Pace& pace, std::uint32_t region,
             std::uint32_t which) noexcept;

/// How far a search looks.
struct Reach {
  float limit = 0;  ///< distances from here on are of no interest
  float margin =
      0;  ///< pairs farther than the nearest by less are kept; < 0: so much may be missed
  bool first = false;               ///< end as soon as any pair nearer than limit is known
  std::uint32_t room = kNearPairs;  ///< pairs that are kept, at most
  Vec3f course{};  ///< of the region: what is proved holds all along it; in b's image coordinates
  float widest = kFarthest;  ///< along a course: ended where what there is no room for leaves a
                             ///< wider interval, in units
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
/// @param left     where the budget ends it: what it has not looked at; else as it was. May be null
/// Cost: the budget, or all pairs of boxes nearer than the answer. No allocation, no recursion.
Bounds search(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
              std::uint32_t region, const Witness& witness, const Reach& reach,
              Remainder* left = nullptr) noexcept;

/// Any pair of all of a nearer than a limit; none is known where there is none, or the budget has
/// ended it. Cost: search()
Witness find_any(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
                 float limit) noexcept;

/// Goes on with a search at the present poses. As search(), but what was seen before is not seen
/// again, unless it was kept and may be nearer than the best by now: complete, `rest` may be less
/// by what has come nearer since. The distances in scratch.near of pairs that were kept before are
/// bounds from below; as long as they have not all been looked at, `rest` is no more than these.
/// @param reach  its course ends where that of the search before did
/// @param moved  how far the region is off that course, at most (moved_since()), in units
/// @param left   of it; where this is ended too, what is left now
Bounds go_on_searching(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch,
                       Pace& pace, const Witness& witness, const Reach& reach, double moved,
                       Remainder& left) noexcept;

/// Adds all pairs of triangles that cross in a region, until the budget is used up. Boxes of
/// crossing triangles overlap, so that none is passed over.
/// @return false where the budget ended it
bool find_crossings(const Kernels& kernels, const levels::PairState& pair, const PairFrame& frame,
                    SearchScratch& scratch, Pace& pace, std::uint32_t region,
                    CrossingList& list) noexcept;

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/work.hpp"

namespace palpate::regions {
namespace {

using levels::PairState;

double way_since_proof(const Work& work, const Active& item) noexcept {
  const PairState& pair = work.pair_of(item);
  const image::Region& region = pair.image_a->regions[item.region];
  return way_since(work.state_of(item).at, pair, static_cast<double>(region.reach));
}

/// RegionPairs::apart of a pair that is so far apart now, or farther.
float apart_since(float distance, double way) noexcept {
  return float_below(static_cast<double>(distance) + way);
}

/// Takes pairs that are measured, those of a region in their order.
class Measured {
 public:
  explicit Measured(Work& work) noexcept : work_(work) {}

  void operator()(std::uint32_t index, const Witness& pair) noexcept {
    const Active& item = work_.active()[index];
    Witness& witness = work_.witness_of(item);
    if (pair.distance < witness.distance) witness = pair;
    if (index != index_) k_ = 0;
    index_ = index;
    RegionPairs& kept = work_.kept_of(item);
    while (k_ < kept.near.count && !kept.near.pairs[k_].same_pair(pair)) ++k_;
    if (k_ == kept.near.count) return;
    kept.apart[k_] = apart_since(pair.distance, way_since_proof(work_, item));
  }

 private:
  Work& work_;
  std::uint32_t index_ = image::kNone;  // of the region
  std::uint32_t k_ = 0;                 // of its kept pairs
};

/// Pairs of triangles of active regions, measured sixteen at a time. Holds pairs, not places where
/// they are kept: what is done with one that has been measured may move others. While it is not
/// empty, nothing else may use the batch of work.memory.search.
class PairBatch {
 public:
  explicit PairBatch(Work& work) noexcept : work_(work), take_(work) {}

  /// @param index  of the active region that the pair is of
  void add(std::uint32_t index, const Witness& pair) noexcept {
    SearchScratch& scratch = *work_.memory.search;
    const std::span<const Active> active = work_.active();
    const bool of_others =
        count_ > 0 && active[scratch.batch_of[0]].pair != active[index].pair;  // other bodies
    if (count_ == kBatch || of_others) measure_all();
    scratch.batch_of[count_] = index;
    scratch.batch_a[count_] = pair.a;
    scratch.batch_b[count_] = pair.b;
    ++count_;
  }

  /// Measures what is left. kBatchUnits units, or none.
  void measure_all() noexcept {
    if (count_ == 0) return;
    float distances[kBatch];
    SearchScratch& scratch = *work_.memory.search;
    const PairFrame& frame = work_.frame_of(work_.active()[scratch.batch_of[0]]);
    regions::measure(*work_.memory.kernels, frame, scratch, work_.pace, count_, distances);
    for (std::uint32_t i = 0; i < count_; ++i) {
      take_(scratch.batch_of[i], Witness{scratch.batch_a[i], scratch.batch_b[i], distances[i]});
    }
    count_ = 0;
  }

 private:
  Work& work_;
  Measured take_;
  std::uint32_t count_ = 0;
};

/// Of a region's kept pairs those that may be nearer than its witness by how they and the bodies
/// have moved.
struct Doubtful {
  std::uint32_t count = 0;
  std::uint32_t of[kNearPairs];  ///< RegionPairs::near
};

Doubtful doubtful_of(const Work& work, const Active& item, double way) noexcept {
  const RegionPairs& kept = work.kept_of(item);
  const Witness& witness = work.witness_of(item);
  const float upper = work.upper_of(item);
  const float nearest = upper + static_cast<float>(way + kMotionSlack);
  Doubtful doubtful;
  for (std::uint32_t k = 0; k < kept.near.count; ++k) {
    const Witness& pair = kept.near.pairs[k];
    if (pair.distance - item.moved >= upper) break;
    if (kept.apart[k] < nearest && !pair.same_pair(witness)) doubtful.of[doubtful.count++] = k;
  }
  return doubtful;
}

/// Leaves those that along the witness's way may be nearer, or that the budget did not do for.
void sift(Work& work, const Active& item, double way, Doubtful& doubtful) noexcept {
  RegionPairs& kept = work.kept_of(item);
  const float upper = work.upper_of(item) - kAsNear;
  std::uint32_t left = 0;
  for (std::uint32_t first = 0; first < doubtful.count; first += kBatch) {
    const std::uint32_t rest = doubtful.count - first;
    const std::uint32_t count = rest < kBatch ? rest : kBatch;
    const bool look = work.pace.go_on();
    float apart[kBatch] = {};
    if (look) {
      Witness pairs[kBatch];
      for (std::uint32_t i = 0; i < kBatch; ++i) {
        pairs[i] = kept.near.pairs[doubtful.of[first + (i < count ? i : 0)]];
      }
      separate(*work.memory.kernels, work.frame_of(item), work.pace, pairs, item.way.along, apart);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t k = doubtful.of[first + i];
      if (look && apart[i] > upper) {
        kept.apart[k] = apart_since(apart[i], way);
      } else {
        doubtful.of[left++] = k;
      }
    }
  }
  doubtful.count = left;
}

/// Where the budget ends this, the others count as not kept: the next is the nearest of them.
void measure(Work& work, std::uint32_t index, const Doubtful& doubtful, PairBatch& batch) noexcept {
  Active& item = work.active()[index];
  const NearPairs& near = work.kept_of(item).near;
  for (std::uint32_t k = 0; k < doubtful.count; ++k) {
    const Witness& pair = near.pairs[doubtful.of[k]];
    if (!work.pace.go_on()) {
      const float lower = pair.distance - item.moved - kRounding;
      item.rest = lower < item.rest ? lower : item.rest;
      return;
    }
    batch.add(index, pair);
  }
}

}  // namespace

void measure_kept(Work& work) noexcept {
  PairBatch batch(work);
  for (std::uint32_t i = 0; i < work.count; ++i) {
    Active& item = work.active()[i];
    if (work.kept_of(item).near.count == 0) continue;
    const double way = way_since_proof(work, item);
    Doubtful doubtful = doubtful_of(work, item, way);
    if (item.way.is_of(work.witness_of(item))) sift(work, item, way, doubtful);
    measure(work, i, doubtful, batch);
  }
  batch.measure_all();
}

}  // namespace palpate::regions

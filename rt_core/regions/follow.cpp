// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/follow.hpp"

#include "rt_core/regions/look_into.hpp"
#include "rt_core/regions/pair_batch.hpp"

namespace palpate::regions {
namespace {

using levels::PairState;

/// Shares of the units at which the next kind of work begins.
constexpr double kSeedsMeasured = 0.35;
constexpr double kWitnessesClimbed = 0.65;
constexpr double kSeedsClimbed = 0.85;
/// A place moves by a triangle in some fifty ticks where surfaces press and slide slowly.
constexpr std::uint32_t kWitnessEvery = 6;
constexpr std::uint32_t kSeedEvery = 2;
constexpr std::uint32_t kMostDives = 8;  ///< of a region in a tick
constexpr std::uint32_t kLooks = 8;      ///< of a region at a time, in place of a dive
/// Regions that begin are as far apart from tick to tick as this; prime.
constexpr std::uint32_t kStride = 61;

class Follower {
 public:
  Follower(Work& work, double units) noexcept
      : work_(work), units_(units), start_(work.pace.used()) {}

  void run() noexcept {
    Pursuit& pursuit = work_.memory.pursuit;
    ++pursuit.round;
    const std::uint32_t count = work_.count;
    PairBatch batch(work_, [this](std::uint32_t i, const Witness& pair) { take(i, pair); });
    for (std::uint32_t k = 0; k < count && within(kSeedsMeasured); ++k) {
      measure_seeds(turn(k), batch);
    }
    batch.measure_all();
    const std::uint64_t before = work_.pace.used();
    for (std::uint32_t k = 0; k < count && within(kWitnessesClimbed); ++k) climb_witness(turn(k));
    const std::uint64_t climbed = work_.pace.used() - before;
    for (std::uint32_t k = 0; k < count && within(kSeedsClimbed); ++k) climb_seed(turn(k));
    for (std::uint32_t k = 0; k < kMostDives * count && within(1); ++k) {
      dive_into(pursuit.next_dive++ % count, batch);
    }
    batch.measure_all();
    // Witnesses climb where regions are searched, too.
    pursuit.follow.add(gain_, static_cast<double>(work_.pace.used() - start_ - climbed));
  }

 private:
  std::uint32_t turn(std::uint32_t k) const noexcept {
    return (k + work_.memory.pursuit.round * kStride) % work_.count;
  }
  bool within(double share) noexcept {
    return static_cast<double>(work_.pace.used() - start_) < share * units_ && work_.pace.go_on();
  }

  bool is_open(const Active& item) noexcept {
    return item.width > kClosed && work_.witness_of(item).known() && work_.is_present(item);
  }

  float below_delta(const Active& item, float distance) noexcept {
    const float delta = work_.delta_of(item);
    return distance < delta ? distance : delta;
  }

  void measure_seeds(std::uint32_t index, auto& batch) noexcept {
    const Active& item = work_.active()[index];
    if (!is_open(item)) return;
    const Witness& witness = work_.witness_of(item);
    const PairState& pair = work_.pair_of(item);
    Seeds& seeds = work_.kept_of(item).seeds;
    const auto moved = static_cast<float>((pair.travel - seeds.travel_at) +
                                          (pair.turn - seeds.turn_at) * pair.scale_a);
    seeds.travel_at = pair.travel;
    seeds.turn_at = pair.turn;
    for (std::uint32_t k = 0; k < seeds.count; ++k) seeds.distance[k] -= moved;
    if (!measure_seed(witness, seeds)) note_seed(*work_.frame_of(item).a, witness, seeds);
    const float upper = below_delta(item, witness.distance);
    for (std::uint32_t k = 0; k < seeds.count; ++k) {
      const Witness seed = seeds.at(k);
      if (seed.distance < upper && !seed.same_pair(witness)) batch.add(index, seed);
    }
  }

  /// A measured pair becomes a seed, and the witness where it is nearer.
  void take(std::uint32_t index, const Witness& pair) noexcept {
    const Active& item = work_.active()[index];
    Seeds& seeds = work_.kept_of(item).seeds;
    if (!measure_seed(pair, seeds)) note_seed(*work_.frame_of(item).a, pair, seeds);
    take_if_nearer(item, pair);
  }

  void take_if_nearer(const Active& item, const Witness& pair) noexcept {
    Witness& witness = work_.witness_of(item);
    if (!(pair.distance < witness.distance)) return;
    const float nearer = below_delta(item, witness.distance) - below_delta(item, pair.distance);
    gain_ += static_cast<double>(nearer) / work_.pair_of(item).delta;
    witness = pair;
  }

  void climb_witness(std::uint32_t index) noexcept {
    Active& item = work_.active()[index];
    if (!is_open(item) || !has_turn(item, kWitnessEvery)) return;
    Witness& witness = work_.witness_of(item);
    const PairFrame& frame = work_.frame_of(item);
    climb(*work_.memory.kernels, frame, *work_.memory.search, work_.pace, witness, item.way);
    note_seed(*frame.a, witness, work_.kept_of(item).seeds);
    item.climbed = true;
  }

  void climb_seed(std::uint32_t index) noexcept {
    const Active& item = work_.active()[index];
    Seeds& seeds = work_.kept_of(item).seeds;
    if (!is_open(item) || seeds.count == 0 || !has_turn(item, kSeedEvery)) return;
    const PairFrame& frame = work_.frame_of(item);
    const std::uint32_t k = work_.memory.pursuit.round / kSeedEvery % seeds.count;
    Witness seed = seeds.at(k);
    seed.distance = kFarthest;  // until it is measured
    climb(*work_.memory.kernels, frame, *work_.memory.search, work_.pace, seed);
    move_seed(*frame.a, k, seed, seeds);
    take_if_nearer(item, seed);
  }

  bool has_turn(const Active& item, std::uint32_t every) const noexcept {
    return (item.region + work_.memory.pursuit.round) % every == 0;
  }

  void dive_into(std::uint32_t index, auto& batch) noexcept {
    const Active& item = work_.active()[index];
    if (!is_open(item)) return;
    if (can_look(work_.frame_of(item))) {
      look_into(work_, index, kLooks, batch);
      return;
    }
    const Witness found = dive(*work_.memory.kernels, work_.frame_of(item), work_.pace, item.region,
                               work_.kept_of(item).seeds.dives++);
    batch.add(index, found);
  }

  Work& work_;
  double units_;
  std::uint64_t start_;
  double gain_ = 0;
};

}  // namespace

void follow(Work& work, double units) noexcept {
  if (work.count > 0) Follower(work, units).run();
}

}  // namespace palpate::regions

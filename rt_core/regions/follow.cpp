// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/follow.hpp"

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
/// Regions that begin are as far apart from tick to tick as this; prime.
constexpr std::uint32_t kStride = 61;

class Follower {
 public:
  Follower(QueryMemory& memory, std::span<Active> active, double units, Pace& pace) noexcept
      : memory_(memory), active_(active), pace_(pace), units_(units), start_(pace.used()) {}

  void run() noexcept {
    Pursuit& pursuit = memory_.pursuit;
    ++pursuit.round;
    const auto count = static_cast<std::uint32_t>(active_.size());
    PairBatch batch(memory_, active_, pace_,
                    [this](std::uint32_t i, const Witness& pair) { take(i, pair); });
    for (std::uint32_t k = 0; k < count && within(kSeedsMeasured); ++k) {
      measure_seeds(turn(k), batch);
    }
    batch.measure_all();
    const std::uint64_t before = pace_.used();
    for (std::uint32_t k = 0; k < count && within(kWitnessesClimbed); ++k) climb_witness(turn(k));
    const std::uint64_t climbed = pace_.used() - before;
    for (std::uint32_t k = 0; k < count && within(kSeedsClimbed); ++k) climb_seed(turn(k));
    for (std::uint32_t k = 0; k < kMostDives * count && within(1); ++k) {
      dive_into(pursuit.next_dive++ % count, batch);
    }
    batch.measure_all();
    // Witnesses climb where regions are searched, too.
    pursuit.follow.add(gain_, static_cast<double>(pace_.used() - start_ - climbed));
  }

 private:
  std::uint32_t turn(std::uint32_t k) const noexcept {
    return (k + memory_.pursuit.round * kStride) % static_cast<std::uint32_t>(active_.size());
  }
  bool within(double share) noexcept {
    return static_cast<double>(pace_.used() - start_) < share * units_ && pace_.go_on();
  }

  const PairState& pair_of(const Active& item) noexcept { return memory_.pairs[item.pair]; }
  const PairFrame& frame_of_item(const Active& item) noexcept { return memory_.frames[item.pair]; }
  RegionState& state_of(const Active& item) noexcept { return memory_.states[item.state]; }
  bool is_open(const Active& item) noexcept {
    const RegionState& state = state_of(item);
    return item.width > kClosed && state.witness.known() && memory_.crowd.has(item.state);
  }

  float below_delta(const Active& item, float distance) noexcept {
    const auto delta = static_cast<float>(pair_of(item).delta);
    return distance < delta ? distance : delta;
  }

  void measure_seeds(std::uint32_t index, auto& batch) noexcept {
    const Active& item = active_[index];
    if (!is_open(item)) return;
    RegionState& state = state_of(item);
    const PairState& pair = pair_of(item);
    Seeds& seeds = state.seeds;
    const auto moved = static_cast<float>((pair.travel - seeds.travel_at) +
                                          (pair.turn - seeds.turn_at) * pair.scale_a);
    seeds.travel_at = pair.travel;
    seeds.turn_at = pair.turn;
    const float upper = below_delta(item, state.witness.distance);
    for (std::uint32_t k = 0; k < seeds.count; ++k) {
      Witness& seed = seeds.at[k];
      seed.distance -= moved;
      if (seed.distance < upper && !seed.same_pair(state.witness)) batch.add(index, seed);
    }
  }

  /// A measured pair becomes a seed, and the witness where it is nearer.
  void take(std::uint32_t index, const Witness& pair) noexcept {
    const Active& item = active_[index];
    const ImageView& a = *frame_of_item(item).a;
    RegionState& state = state_of(item);
    note_seed(a, state.witness, state.seeds);
    note_seed(a, pair, state.seeds);
    take_if_nearer(item, pair);
  }

  void take_if_nearer(const Active& item, const Witness& pair) noexcept {
    Witness& witness = state_of(item).witness;
    if (!(pair.distance < witness.distance)) return;
    const float nearer = below_delta(item, witness.distance) - below_delta(item, pair.distance);
    gain_ += static_cast<double>(nearer) / pair_of(item).delta;
    witness = pair;
  }

  void climb_witness(std::uint32_t index) noexcept {
    Active& item = active_[index];
    if (!is_open(item) || !has_turn(item, kWitnessEvery)) return;
    RegionState& state = state_of(item);
    const PairFrame& frame = frame_of_item(item);
    climb(*memory_.kernels, frame, *memory_.search, pace_, state.witness);
    note_seed(*frame.a, state.witness, state.seeds);
    item.climbed = true;
  }

  void climb_seed(std::uint32_t index) noexcept {
    const Active& item = active_[index];
    Seeds& seeds = state_of(item).seeds;
    if (!is_open(item) || seeds.count == 0 || !has_turn(item, kSeedEvery)) return;
    const PairFrame& frame = frame_of_item(item);
    const std::uint32_t k = memory_.pursuit.round / kSeedEvery % seeds.count;
    Witness seed = seeds.at[k];
    seed.distance = kFarthest;  // until it is measured
    climb(*memory_.kernels, frame, *memory_.search, pace_, seed);
    move_seed(*frame.a, k, seed, seeds);
    take_if_nearer(item, seed);
  }

  bool has_turn(const Active& item, std::uint32_t every) const noexcept {
    return (item.region + memory_.pursuit.round) % every == 0;
  }

  void dive_into(std::uint32_t index, auto& batch) noexcept {
    const Active& item = active_[index];
    if (!is_open(item)) return;
    const Witness found = dive(*memory_.kernels, frame_of_item(item), pace_, item.region,
                               state_of(item).seeds.dives++);
    batch.add(index, found);
  }

  QueryMemory& memory_;
  std::span<Active> active_;
  Pace& pace_;
  double units_;
  std::uint64_t start_;
  double gain_ = 0;
};

}  // namespace

void follow(QueryMemory& memory, std::span<Active> active, double units, Pace& pace) noexcept {
  if (!active.empty()) Follower(memory, active, units, pace).run();
}

}  // namespace palpate::regions

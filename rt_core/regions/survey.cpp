// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/survey.hpp"

#include "rt_core/regions/lookout.hpp"
#include "rt_core/regions/motion.hpp"

namespace palpate::regions {
namespace {

/// So many regions tell a force. With fewer looks than these they meet nothing near.
constexpr double kTelling = 64;
/// Of a tick: where it has fewer it does not begin.
constexpr double kFewestUnits = 64;
constexpr double kFewestLooks = 4;
/// More see little that is new in a region; a climb from the nearest does more.
constexpr double kMostSpread = 16;
static_assert(kMostSpread <= kMostLooks);
/// Of a region, so that more regions are seen: what fewer meet in each is too far from its nearest.
constexpr double kLeastSpread = 10;
/// Of regions that are seen: where more of them are felt, those that are not seen push as their
/// neighbours do, and it is better to know some well.
constexpr double kFeltAllOver = 0.75;
/// Beside the nearest, of each that is spread over a region.
constexpr double kBeside = 0.5;
constexpr std::uint32_t kRegionsPerRound = 16;
constexpr std::uint32_t kMostRounds = 64;
/// So many rounds are repeated, each with other places, before the next ones begin: a force is told
/// better by some two hundred regions that are known well than by twice as many that are not.
constexpr std::uint32_t kTellingRounds = 12;
constexpr std::uint32_t kMostRepeats = 8;
/// Of the survey's units: once the first rounds have been seen, the rest does more in climbs and
/// searches from there than in more looks; and all of it does where that is enough for searching
/// what is felt, and half as much again.
constexpr double kMostForRepeats = 0.8;
constexpr double kEnough = 1.5;

class Survey {
 public:
  Survey(Work& work, double share) noexcept
      : work_(work),
        share_(share),
        in_order_(work.memory.queue),
        lookout_(work),
        began_ns_(work.meter.elapsed_ns()),
        began_at_(work.pace.used()) {
    std::uint32_t open = 0;
    for (const Active& item : work.active()) open += is_open(item) ? 1u : 0u;
    const double telling = open < kTelling ? open : kTelling;
    const double units = share * work.units_left(expected_ns());
    set_looks(units / (telling * (1 + kBeside) * kUnitsPerLook), kFewestLooks, kMostSpread);
    const std::uint32_t rounds = open / kRegionsPerRound + 1;
    rounds_ = rounds < kMostRounds ? rounds : kMostRounds;
  }

  bool run() noexcept {
    sort_by_round();
    const std::uint32_t before = work_.anew ? 0 : rounds_seen();
    const std::uint32_t seen = work_.anew ? begin() : go_on(before, rounds_);
    lookout_.measure_all();
    if (seen == before) return false;
    if (work_.anew && !work_.swept) forget_unseen(seen);
    work_.memory.pursuit.surveyed = static_cast<double>(seen) / rounds_;
    if (pace_ns() > 0) palpate::follow(work_.memory.pursuit.survey_ns, pace_ns());
    return true;
  }

 private:
  /// @return how many rounds have been seen
  std::uint32_t begin() noexcept {
    const std::uint32_t telling = rounds_ < kTellingRounds ? rounds_ : kTellingRounds;
    std::uint32_t seen = 0;
    do {
      see(seen++);
      spread_thinner(seen, telling);
    } while (seen < telling && has_units_for(seen, share_));
    if (seen < telling) return seen;
    for (std::uint32_t i = telling; i < kMostRepeats * telling; ++i) {
      if (felt_can_be_searched()) break;
      if (!has_units_for(i % telling, kMostForRepeats * share_)) return seen;
      see(i % telling);
    }
    return go_on(seen, rounds_);
  }

  void set_looks(double spread, double fewest, double most) noexcept {
    looks_ = static_cast<std::uint32_t>(spread < fewest ? fewest : spread < most ? spread : most);
    beside_ = static_cast<std::uint32_t>(kBeside * looks_);
  }

  /// So that all telling rounds are seen, where what is felt is felt here and there: by what those
  /// seen so far have taken of what they might have.
  void spread_thinner(std::uint32_t seen, std::uint32_t telling) noexcept {
    for (const std::uint32_t i : regions_of(seen - 1)) {
      ++regions_seen_;
      felt_of_seen_ += work_.is_felt(work_.active()[i]) ? 1u : 0u;
    }
    most_units_seen_ += most_units(seen - 1);
    if (looks_ <= kLeastSpread || felt_of_seen_ > kFeltAllOver * regions_seen_) return;
    double most = 0;
    for (std::uint32_t round = seen; round < telling; ++round) most += most_units(round);
    const double expected = most * static_cast<double>(spent()) / most_units_seen_;
    const double left = left_of(share_);
    if (left < expected) set_looks(looks_ * left / expected, kLeastSpread, looks_);
  }

  /// Rounds are of everywhere, each; the rest is of where the bodies were, and felt on some sides
  /// only.
  void forget_unseen(std::uint32_t seen) noexcept {
    const std::span<const Active> active = work_.active();
    std::size_t end = 0;
    for (std::size_t first = 0; first < active.size(); first = end) {
      bool felt = false;
      for (end = first; end < active.size() && active[end].pair == active[first].pair; ++end) {
        const Active& item = active[end];
        felt |= is_open(item) && work_.is_felt(item) && is_before(seen, item);
      }
      const bool moved = has_moved_on(work_.pair_of(active[first]), work_.memory.pursuit.lagged);
      if (felt && moved) forget_unseen(active.subspan(first, end - first), seen);
    }
  }
  /// What crosses does so wherever it was found.
  void forget_unseen(std::span<const Active> of_pair, std::uint32_t seen) noexcept {
    for (const Active& item : of_pair) {
      const bool unseen = is_open(item) && !is_before(seen, item);
      if (unseen && !work_.is_crossing(item)) work_.witness_of(item) = {};
    }
  }

  bool felt_can_be_searched() const noexcept {
    const Pursuit& pursuit = work_.memory.pursuit;
    std::uint32_t open = 0;
    for (const Active& item : work_.active()) {
      open += is_open(item) && work_.is_felt(item) ? 1u : 0u;
    }
    return pursuit.searches > 0 && kEnough * open * pursuit.search_units < affordable();
  }

  /// Of as many rounds as there are now, by the surveys before.
  std::uint32_t rounds_seen() const noexcept {
    const double done = work_.memory.pursuit.surveyed * rounds_;
    std::uint32_t round = 0;
    while (round + 0.5 < done) ++round;
    return round;
  }

  std::uint32_t go_on(std::uint32_t round, std::uint32_t end) noexcept {
    while (round < end && has_units_for(round, share_)) see(round++);
    return round;
  }

  /// Open regions, those of a round one after the other and in the order of active ones.
  void sort_by_round() noexcept {
    for (const Active& item : work_.active()) {
      if (is_open(item)) ++end_of_[round_of(item)];
    }
    std::uint32_t first = 0;
    for (std::uint32_t round = 0; round < rounds_; ++round) {
      const std::uint32_t count = end_of_[round];
      end_of_[round] = first;
      first += count;
    }
    for (std::uint32_t i = 0; i < work_.count; ++i) {
      const Active& item = work_.active()[i];
      if (is_open(item)) in_order_[end_of_[round_of(item)]++] = i;
    }
  }

  std::span<const std::uint32_t> regions_of(std::uint32_t round) const noexcept {
    const std::uint32_t first = round > 0 ? end_of_[round - 1] : 0;
    return in_order_.subspan(first, end_of_[round] - first);
  }

  std::uint32_t round_of(const Active& item) const noexcept {
    const auto regions = work_.pair_of(item).image_a->regions;
    return static_cast<std::uint32_t>(std::uint64_t{regions[item.region].rank} * rounds_ /
                                      regions.size());
  }
  /// Whether its turn comes before this round: round_of() < round, without a division.
  bool is_before(std::uint32_t round, const Active& item) const noexcept {
    const auto regions = work_.pair_of(item).image_a->regions;
    return std::uint64_t{regions[item.region].rank} * rounds_ < round * regions.size();
  }

  /// A round that is begun is ended, as far as that can be told: half of one is of one side.
  bool has_units_for(std::uint32_t round, double share) noexcept {
    if (!work_.pace.go_on()) return false;
    return most_units(round) <= left_of(share);
  }

  /// Where each region of it takes all looks.
  double most_units(std::uint32_t round) const noexcept {
    return static_cast<double>(regions_of(round).size()) * (looks_ + beside_) * kUnitsPerLook;
  }
  /// Units that a share of the tick has left.
  double left_of(double share) const noexcept {
    const auto used = static_cast<double>(work_.pace.used());
    return share * (used + affordable()) - used;
  }
  /// Units, by the survey.
  std::uint64_t spent() const noexcept { return work_.pace.used() - began_at_; }

  /// Work units that the tick has left: at the pace of the survey, which is another than that of
  /// what came before it; before its first round, at that of surveys of late.
  double affordable() const noexcept {
    const std::uint64_t unit_ns = pace_ns();
    return work_.meter.queries_affordable(unit_ns > 0 ? unit_ns : expected_ns());
  }
  /// Time that a unit has taken so far; 0: none was used, or there is no clock.
  std::uint64_t pace_ns() const noexcept {
    return spent() > 0 ? (work_.meter.elapsed_ns() - began_ns_) / spent() : 0;
  }
  /// Before the first round: as surveys of late, which what the host did to one may have made long,
  /// but no longer than other units.
  std::uint64_t expected_ns() const noexcept {
    const std::uint64_t of_late = work_.memory.pursuit.survey_ns;
    const std::uint64_t others = work_.unit_ns();
    return of_late > 0 && of_late < others ? of_late : others;
  }

  void see(std::uint32_t round) noexcept {
    const std::uint32_t first = looks_ / 4;
    const std::uint32_t rest = looks_ - first;
    const auto look_once = [&](const Active& item, Looks& out) {
      look_on(work_, item, first, out);
    };
    // A quarter of them tells where there is something to find.
    const auto look_again = [&](const Active& item, Looks& out) {
      if (work_.may_climb(item)) look_on(work_, item, rest, out);
    };
    const auto beside_nearest = [&](const Active& item, Looks& out) {
      if (!work_.is_felt(item)) return;
      look_beside(work_.frame_of(item), item.region, work_.witness_of(item).a, beside_, out);
    };
    const std::span<const std::uint32_t> regions = regions_of(round);
    lookout_.see_each(regions, first, look_once, true);
    lookout_.see_each(regions, rest, look_again, false);
    lookout_.measure_all();
    lookout_.see_each(regions, beside_, beside_nearest, false);
  }

  Work& work_;
  double share_;
  std::span<std::uint32_t> in_order_;       // of active regions, see sort_by_round()
  std::uint32_t end_of_[kMostRounds] = {};  // of each round, in that
  Lookout lookout_;
  std::uint64_t began_ns_;    // since the tick began
  std::uint64_t began_at_;    // in units of the tick
  std::uint32_t looks_ = 0;   // spread over a region
  std::uint32_t beside_ = 0;  // beside the nearest of them
  std::uint32_t rounds_ = 0;
  std::uint32_t regions_seen_ = 0;
  std::uint32_t felt_of_seen_ = 0;
  double most_units_seen_ = 0;  // of the rounds seen, see most_units()
};

}  // namespace

bool survey(Work& work, double share) noexcept {
  return work.count > 0 && Survey(work, share).run();
}

bool can_survey(const Work& work) noexcept {
  return work.count > 0 && work.units_of_tick() >= kFewestUnits &&
         can_look(work.frame_of(work.active()[0]));
}

}  // namespace palpate::regions

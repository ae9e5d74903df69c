// SPDX-License-Identifier: Apache-2.0
// Looks of many regions together, and of what they meet what may be nearer than what is known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/regions/look_into.hpp"
#include "rt_core/regions/pair_batch.hpp"

namespace palpate::regions {

/// Together they wait for memory less than where they are alone, and so many count as a unit.
inline constexpr std::uint32_t kTogetherPerUnit = 6;
inline constexpr double kMeasuredLooks = 0.15;  ///< the others cannot be nearer
/// About, and with what it takes to bound and to measure what they meet. Planned is as if they were
/// alone: what is begun is ended.
inline constexpr double kUnitsPerLook =
    1.0 / kLooksPerUnit + (kBoundUnits + kMeasuredLooks * kBatchUnits) / kBatch;

inline bool is_open(const Active& item) noexcept { return item.width > kClosed; }

/// What is nearer becomes a region's witness, and a seed; widths and urgencies are to be told anew
/// (Work::widen). While there is one with pairs not measured, nothing else may use the batch of
/// work.memory.search.
class Lookout {
 public:
  explicit Lookout(Work& work) noexcept : work_(work), batch_(work, Take{this}) {
    for (const Active& item : work.active()) {
      if (!work.is_contact(item)) continue;
      ++felt_;
      crossing_ += work.is_crossing(item) ? 1u : 0u;
    }
  }
  Lookout(const Lookout&) = delete;
  Lookout& operator=(const Lookout&) = delete;

  /// Looks from the places that are chosen in each region, and measures what they meet, but for the
  /// last pairs.
  /// @param regions  indices of active ones
  /// @param most     looks of a region, at most kMostLooks
  /// @param choose   called as choose(item, looks), to which it adds
  /// @param unseen   regions that may have no witness yet
  void see_each(std::span<const std::uint32_t> regions, std::uint32_t most, auto choose,
                bool unseen) noexcept {
    while (!regions.empty()) {
      const std::size_t count = regions.size() < kBatch ? regions.size() : kBatch;
      const std::span<Sight> sights = look(regions.first(count), most, choose);
      if (unseen) measure_nearest(sights);
      measure_rest(sights);
      if (!work_.pace.go_on()) return;
      regions = regions.subspan(count);
    }
  }

  /// Measures what is left. kBatchUnits units, or none.
  void measure_all() noexcept { batch_.measure_all(); }

 private:
  struct Take {
    Lookout* lookout;
    void operator()(std::uint32_t index, const Witness& pair) const noexcept {
      lookout->take(index, pair);
    }
  };

  /// Looks of regions of one pair of bodies, all in the same step.
  struct Party {
    Looks looks;
    std::uint32_t of[kMostLooks];  // which active region each is of
    const PairFrame* frame = nullptr;
  };

  /// Memory is slow: while one party's pairs are bounded, the looks of the next ones are on their
  /// way; and a few looks at a time would wait for it as long as many.
  /// @param regions  at most kBatch
  /// @return what they have met that may be nearer than what is known, region by region
  std::span<Sight> look(std::span<const std::uint32_t> regions, std::uint32_t most,
                        auto choose) noexcept {
    static_assert(kMostLooks * kBatch <= kSights);
    Party on_their_way[kLookSteps];
    std::size_t sent = 0;
    std::uint32_t met = 0;
    for (std::uint32_t k = 0, left = kLookSteps; left > 0; ++k) {
      sent = send(regions, sent, most, choose, on_their_way[k % kLookSteps]);
      for (std::uint32_t step = 0; step < kLookSteps && step <= k; ++step) {
        Party& party = on_their_way[(k - step) % kLookSteps];
        if (party.looks.count == 0) continue;
        look_step(*work_.memory.kernels, *party.frame, step, party.looks);
      }
      if (sent == regions.size()) --left;
      if (k + 1 < kLookSteps) continue;
      if (!work_.pace.go_on()) break;
      met = note_sights(on_their_way[(k + 1) % kLookSteps], met);
    }
    return std::span(work_.memory.search->sights).first(met);
  }

  /// @param party  gets looks of as many regions as there is room for; none where all are sent
  /// @return the first region that is not sent yet
  std::size_t send(std::span<const std::uint32_t> regions, std::size_t next, std::uint32_t most,
                   auto choose, Party& party) noexcept {
    Looks& looks = party.looks;
    std::uint32_t count = looks.count = 0;
    for (; next < regions.size() && count + most <= kMostLooks; ++next) {
      const Active& item = work_.active()[regions[next]];
      const PairFrame& frame = work_.frame_of(item);
      if (count > 0 && party.frame != &frame) break;
      party.frame = &frame;
      if (can_look(frame)) choose(item, looks);
      for (; count < looks.count; ++count) party.of[count] = regions[next];
    }
    return next;
  }

  /// @param met  so many are noted before
  /// @return and so many with these
  std::uint32_t note_sights(Party& party, std::uint32_t met) noexcept {
    Looks& looks = party.looks;
    if (looks.count == 0) return met;
    work_.pace.charge((looks.count + kTogetherPerUnit / 2) / kTogetherPerUnit);
    for (std::uint32_t i = looks.count; i < kBatch; ++i) {
      looks.a[i] = looks.a[0];
      looks.b[i] = looks.b[0];
    }
    float least[kBatch];
    bound(*work_.memory.kernels, *party.frame, *work_.memory.search, work_.pace, looks.a, looks.b,
          least);
    std::uint32_t of = image::kNone;
    float known = 0;
    for (std::uint32_t i = 0; i < looks.count; ++i) {
      if (party.of[i] != of) known = known_of(of = party.of[i]);
      if (!(least[i] < known)) continue;
      work_.memory.search->sights[met++] = {of, {looks.a[i], looks.b[i], least[i]}};
    }
    return met;
  }

  /// Of each region what seems to be the nearest: few of the others can be nearer than that.
  void measure_nearest(std::span<Sight> sights) noexcept {
    std::size_t end = 0;
    for (std::size_t first = 0; first < sights.size(); first = end) {
      std::size_t nearest = first;
      for (end = first; end < sights.size() && sights[end].of == sights[first].of; ++end) {
        if (sights[end].pair.distance < sights[nearest].pair.distance) nearest = end;
      }
      measure_once(sights[nearest]);
    }
    batch_.measure_all();
  }
  void measure_rest(std::span<Sight> sights) noexcept {
    for (Sight& sight : sights) {
      if (may_be_nearer(sight) && !work_.pace.go_on()) return;
      measure_once(sight);
    }
  }
  bool may_be_nearer(const Sight& sight) const noexcept {
    return sight.pair.distance < known_of(sight.of);
  }
  /// What an active region's looks have to be nearer than.
  float known_of(std::uint32_t index) const noexcept {
    const Witness& witness = work_.witness_of(work_.active()[index]);
    return witness.known() ? witness.distance : kFarthest;
  }
  void measure_once(Sight& sight) noexcept {
    if (!may_be_nearer(sight)) return;
    batch_.add(sight.of, sight.pair);
    sight.pair.distance = kFarthest;
  }

  void take(std::uint32_t index, const Witness& pair) noexcept {
    const Active& item = work_.active()[index];
    Witness& witness = work_.witness_of(item);
    if (witness.known() && !(pair.distance < witness.distance)) return;
    const bool was_felt = work_.is_felt(item);
    const bool crossed = work_.is_crossing(item);
    witness = pair;
    // Every look as a seed would cost a fifth of the survey.
    note_seed(*work_.frame_of(item).a, pair, work_.kept_of(item).seeds);
    // Contacts take time and units, too: no more are sought than can be told.
    const bool meets = !was_felt && work_.is_felt(item);
    const bool enters = !crossed && work_.is_crossing(item);
    felt_ += meets ? 1u : 0u;
    crossing_ += enters ? 1u : 0u;
    if (meets || enters) work_.leave_for_report(felt_, crossing_);
  }

  Work& work_;
  PairBatch<Take> batch_;
  std::uint64_t felt_ = 0;      // of active regions
  std::uint64_t crossing_ = 0;  // likewise
};

}  // namespace palpate::regions

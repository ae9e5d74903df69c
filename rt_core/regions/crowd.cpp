// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/crowd.hpp"

#include <limits>

#include "rt_core/regions/work.hpp"

namespace palpate::regions {
namespace {

/// A tick's change of a presence.
constexpr float kFade = 1.0f / 16;
/// The same of what crosses, which may be deep already when it is found, and of those who go where
/// so many times what there is time for are felt: that ticks end in time comes first.
constexpr float kFastFade = 1.0f / 4;
constexpr double kFarTooMany = 1.5;
/// Fewer stay where they are more than what there is time for by a quarter, and more where two
/// sixteenths more would not be too many: time is never quite the same.
constexpr double kMostOver = 1.25;
constexpr std::uint32_t kSlack = 2;
/// So few regions are not thinned out: a force would miss any of them.
constexpr double kFewestFelt = 32;
/// So many tell a force well. Where searches do not keep up, of more the geometric mean of this and
/// of those there is time for are felt: the others' time does more for the witnesses of these.
constexpr double kTelling = 128;
/// In which order neighbours stay: whoever is left is far from the others (van der Corput 1935).
constexpr std::uint32_t kOrder[Crowd::kAll] = {0, 8, 4, 12, 2, 10, 6, 14,
                                               1, 9, 5, 13, 3, 11, 7, 15};

class Thinning {
 public:
  Thinning(QueryMemory& memory, std::span<const Active> active, double most) noexcept
      : memory_(memory),
        active_(active),
        fade_(memory.crowd.felt > kFarTooMany * most ? kFastFade : kFade) {}

  /// @return how many stay, without those that cross
  std::uint32_t run() noexcept {
    std::uint32_t stay = 0;
    memory_.crowd.felt = 0;
    for (std::size_t i = 0; i < active_.size();) {
      const std::size_t end = neighbours_end(i);
      stay += thin_out_neighbours(active_.subspan(i, end - i));
      i = end;
    }
    return stay;
  }

  /// After run(): whether all active regions are felt wholly.
  [[nodiscard]] bool whole() const noexcept { return whole_; }

 private:
  const Witness& witness_of(const Active& item) noexcept { return memory_.witnesses[item.state]; }

  std::size_t neighbours_end(std::size_t first) noexcept {
    const Active& head = active_[first];
    std::size_t end = first + 1;
    while (end < active_.size() && active_[end].pair == head.pair &&
           active_[end].region / Crowd::kAll == head.region / Crowd::kAll) {
      ++end;
    }
    return end;
  }

  bool stays(const Active& item) noexcept {
    return kOrder[item.region % Crowd::kAll] < memory_.crowd.share;
  }

  std::uint32_t thin_out_neighbours(std::span<const Active> neighbours) noexcept {
    bool nobody_stays = true;  // of those that are felt
    for (const Active& item : neighbours) {
      if (is_apart(item) && stays(item)) nobody_stays = false;
    }
    bool alone = nobody_stays;  // the first that is felt, in their place
    std::uint32_t stay = 0;
    for (const Active& item : neighbours) {
      float& absence = memory_.crowd.absence[item.state];
      if (is_apart(item)) {
        const bool here = alone || stays(item);
        alone = false;
        absence = moved(absence, here ? -kFade : fade_);
        stay += here ? 1u : 0u;
        memory_.crowd.felt += absence < 1 ? 1u : 0u;
      } else if (witness_of(item).crosses()) {
        absence = moved(absence, -kFastFade);
      } else {
        absence = nobody_stays || stays(item) ? 0 : 1;
      }
      whole_ = whole_ && absence == 0;
    }
    return stay;
  }

  /// Felt, and does not cross.
  bool is_apart(const Active& item) noexcept {
    const Witness& witness = witness_of(item);
    const auto delta = static_cast<float>(memory_.pairs[item.pair].delta);
    return witness.nearer_than(delta) && !witness.crosses();
  }

  static float moved(float from, float by) noexcept {
    const float to = from + by;
    return to < 0 ? 0 : to < 1 ? to : 1;
  }

  QueryMemory& memory_;
  std::span<const Active> active_;
  float fade_;  // of those who go
  bool whole_ = true;
};

}  // namespace

void thin_out(QueryMemory& memory, std::span<const Active> active, double most) noexcept {
  Crowd& crowd = memory.crowd;
  if (!crowd.thinned && static_cast<double>(active.size()) <= most) return;
  Thinning thinning(memory, active, most);
  const double stay = thinning.run();
  std::uint32_t& share = crowd.share;
  if (share > 1 && stay > kMostOver * most) {
    const double less = most > 0 ? share * most / stay : 0;
    share = less > 1 ? static_cast<std::uint32_t>(less) : 1;
  } else if (share < Crowd::kAll && stay * (share + kSlack) <= most * share) {
    ++share;
  }
  crowd.thinned = true;
  if (share == Crowd::kAll && thinning.whole()) crowd.gather_all();
}

void thin_out(Work& work) noexcept {
  const double all = work.meter.contacts_affordable();
  if (all == std::numeric_limits<double>::infinity() || work.swept) {
    work.memory.crowd.gather_all();
    return;
  }
  std::uint64_t crossing = 0;
  for (const Active& item : work.active()) crossing += work.is_crossing(item) ? 1u : 0u;
  const auto taken = static_cast<double>(tail_contacts(0, crossing));
  double most = taken < 0.5 * all ? all - taken : 0.5 * all;
  if (work.memory.pursuit.lagged && most > kTelling) most = sqrt_of(kTelling * most);
  thin_out(work.memory, work.active(), most > kFewestFelt ? most : kFewestFelt);
}

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/watch.hpp"

#include "rt_core/regions/close.hpp"
#include "rt_core/regions/lookout.hpp"
#include "rt_core/regions/survey.hpp"

namespace palpate::regions {
namespace {

/// Of what the tick has left, the climbs' after the looks. What is there is found by the looks of a
/// few ticks; a climb that does not lead anywhere is told by a look along the witness's way.
constexpr double kLooked = 0.05;
constexpr double kClimbed = 0.4;
constexpr std::uint32_t kLooks = 8;  ///< of a region at a time

class Watch {
 public:
  explicit Watch(Work& work) noexcept : work_(work) {}

  void look() noexcept {
    const double most = kLooked * work_.units_left() / (kLooks * kUnitsPerLook);
    std::uint32_t& next = work_.memory.pursuit.next_look;
    const std::span<std::uint32_t> chosen = work_.memory.queue;
    std::uint32_t count = 0;
    const std::uint32_t first = next;
    for (std::uint32_t k = 0; k < work_.count && count + 1 <= most; ++k) {
      const std::uint32_t i = (first + k) % work_.count;
      const Active& item = work_.active()[i];
      if (!is_doubtful(item) || work_.is_felt(item) || !can_look(work_.frame_of(item))) continue;
      chosen[count++] = i;
      next = i + 1;
    }
    if (count == 0) return;
    Lookout lookout(work_);
    const auto look_some = [&](const Active& item, Looks& out) {
      look_on(work_, item, kLooks, out);
    };
    lookout.see_each(chosen.first(count), kLooks, look_some, false);
    lookout.measure_all();
    for (const std::uint32_t i : chosen.first(count)) work_.widen(work_.active()[i]);
  }

  void climb() noexcept {
    std::uint32_t& next = work_.memory.pursuit.next_climb;
    work_.limit_to(kClimbed);
    const std::uint32_t first = next;
    for (std::uint32_t k = 0; k < work_.count; ++k) {
      const std::uint32_t i = (first + k) % work_.count;
      Active& item = work_.active()[i];
      if (!is_doubtful(item) || !work_.may_climb(item)) continue;
      if (!work_.pace.go_on()) break;
      climb_from_witness(work_, item);
      next = i + 1;
    }
    work_.pace.no_limit();
    work_.truncated = !work_.pace.go_on();
  }

 private:
  /// Anything may be near.
  bool is_doubtful(const Active& item) const noexcept {
    return is_open(item) && item.rest <= 0 && work_.is_present(item);
  }

  Work& work_;
};

}  // namespace

void watch(Work& work) noexcept {
  if (!can_survey(work)) return;
  Watch watch(work);
  watch.look();
  watch.climb();
}

}  // namespace palpate::regions

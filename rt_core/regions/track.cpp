// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/track.hpp"

#include "rt_core/base/queue.hpp"
#include "rt_core/regions/close.hpp"
#include "rt_core/regions/motion.hpp"

namespace palpate::regions {
namespace {

/// Of what the tick has left: the rest is for what is new.
constexpr double kMostTracked = 0.5;

class Tracking {
 public:
  explicit Tracking(Work& work) noexcept
      : work_(work), sliding_(work.memory.queue, NearerWitness{work}) {}

  void run() noexcept {
    for (std::uint32_t i = 0; i < work_.count; ++i) {
      if (slides(work_.active()[i])) sliding_.push(i);
    }
    if (sliding_.empty()) return;
    work_.limit_to(kMostTracked);
    while (!sliding_.empty() && work_.pace.go_on()) {
      Active& item = work_.active()[sliding_.top()];
      sliding_.pop();
      Beside beside;
      climb_from_witness(work_, item, &beside);
      for (std::uint32_t k = 0; k < beside.count; ++k) hand_on(item, beside.pairs[k]);
    }
    work_.pace.no_limit();
    work_.truncated = !work_.pace.go_on();
  }

 private:
  /// Those that do are in the queue, and no others.
  bool slides(const Active& item) const noexcept {
    return item.width > kClosed && work_.may_climb(item) && work_.is_present(item) &&
           !(margin_of(work_.pair_of(item)) > 0);
  }

  /// To the region that a pair is of.
  void hand_on(const Active& from, const Witness& pair) noexcept {
    const std::uint32_t region = work_.frame_of(from).a->region_triangles[pair.a].region;
    const std::uint32_t index = work_.active_of(from.state - from.region + region);
    if (index == image::kNone || !pair.nearer_than(work_.delta_of(from))) return;
    Active& item = work_.active()[index];
    Witness& witness = work_.witness_of(item);
    // One that slides has a place of its own to climb from.
    if (slides(item) || (witness.known() && !(pair.distance < witness.distance))) return;
    witness = pair;
    item.climbed = false;
    work_.widen(item);
    if (slides(item)) sliding_.push(index);
  }

  Work& work_;
  MinQueue<std::uint32_t, NearerWitness> sliding_;  // of active regions
};

}  // namespace

void track(Work& work) noexcept { Tracking(work).run(); }

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/work.hpp"

namespace palpate::regions {
namespace {

/// What may cross the other body goes first, as if its interval were wider by so many delta: how
/// deep it would be is not in it. Not after a jump, when nothing is known of anything.
constexpr float kMayCross = 1;
/// Intervals narrower than this, in delta, change the force little: of those, under a budget, what
/// costs least to prove goes first, so that the certificate gains most. None of them goes before a
/// wider one.
constexpr float kNarrow = 0.2f;
/// What is not felt, because others beside it are, goes last.
constexpr float kNotFelt = 1e-3f;
/// After a jump nearly everything is open, and what is deepest decides the force: a contact counts
/// with the square of its depth (force/penalty.hpp), which of a shallow one may still grow; and the
/// more of that, the less others push the same way (lone.hpp). Of what no contact is known of, few
/// have one, and the fewer the farther what has been seen of it. A climb is cheap.
constexpr float kShallow = 0.1f;
constexpr float kNoContact = 0.1f;
constexpr float kNotClimbed = 5;
/// The same while nothing is felt at all: contacts are likelier where something was seen near.
constexpr float kUnseen = 0.025f;

}  // namespace

std::uint32_t Work::active_of(std::uint32_t state) const noexcept {
  const std::span<const Active> in_order = active();
  std::uint32_t first = 0;
  std::uint32_t end = count;
  while (first < end) {
    const std::uint32_t middle = (first + end) / 2;
    if (in_order[middle].state < state) {
      first = middle + 1;
    } else {
      end = middle;
    }
  }
  return first < count && in_order[first].state == state ? first : image::kNone;
}

bool Work::may_touch_unfelt(std::uint32_t pair) const noexcept {
  bool open = false;
  for (const Active& item : active()) {
    if (item.pair != pair) continue;
    if (is_contact(item)) return false;
    open |= item.width > kClosed;
  }
  return open;
}

void Work::leave_for_report(std::uint64_t felt, std::uint64_t crossing) noexcept {
  const double listing = static_cast<double>(crossing) * memory.pursuit.listing_units;
  std::uint64_t inside = 0;
  for (const Containment& kept : memory.containment) inside += kept.count;
  meter.expect_contacts(tail_contacts(felt + inside, crossing));
  meter.set_aside(static_cast<std::uint64_t>(listing));
}

bool Work::may_climb(const Active& item) const noexcept {
  return !item.climbed && witness_of(item).nearer_than(kClimbReach * delta_of(item));
}

float Work::weight_of_unknown(const Active& item) const noexcept {
  const Witness& witness = witness_of(item);
  const float climb = anew && may_climb(item) ? kNotClimbed : 1;
  if (!witness.known()) return touching ? kNoContact : kUnseen;
  if (!is_felt(item)) return climb * kNoContact * delta_of(item) / witness.distance;
  return climb * item.lone * mass_of(item);
}

float Work::mass_of(const Active& item) const noexcept {
  const float depth = 1 - upper_of(item) / delta_of(item);
  return kShallow + depth * depth;
}

float Work::worth(const Active& item) const noexcept {
  const float weighted = item.width / item.weight;
  if (demand.tolerance_m > 0) return weighted;
  const float narrow = kNarrow * delta_of(item);
  if (item.width >= narrow) return item.width;
  return weighted < narrow ? weighted : narrow;
}

void Work::widen(Active& item) noexcept {
  const float upper = upper_of(item);
  item.width = upper > item.rest ? upper - (item.rest > 0 ? item.rest : 0) : 0;
  const bool unknown = is_felt(item) || !witness_of(item).known();
  const bool may_cross = demand.limited && !anew && item.rest <= 0 && unknown;
  const float doubt = may_cross ? kMayCross * delta_of(item) : 0;
  item.urgency = item.width > kClosed ? worth(item) + doubt : 0;
  if ((anew || !touching) && demand.limited) item.urgency *= weight_of_unknown(item);
  if (!is_present(item)) item.urgency *= kNotFelt;
}

void Work::weigh_all() noexcept {
  float sum = 0;
  float known = 0;
  for (Active& item : active()) {
    item.weight = sqrt_of(state_of(item).cost);
    sum += item.weight;
    known += item.weight > 0 ? 1.0f : 0.0f;
  }
  for (Active& item : active()) item.weight = item.weight > 0 ? item.weight * known / sum : 1;
}

void Work::widen_all() noexcept {
  for (Active& item : active()) widen(item);
}

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
// The one queue of a query, over all pairs of bodies: what waits to be measured or split.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/assert.hpp"
#include "rt_core/base/queue.hpp"
#include "rt_core/levels/rules.hpp"

namespace palpate::levels {

/// A node waiting for its query or, once measured, for its split.
struct Waiting {
  double rank = 0;     ///< less comes first
  double lower_m = 0;  ///< the proved lower bound of its distance in metres
  std::uint32_t node = 0;
  bool later = false;  ///< adds detail: after all that only renews contacts
  bool keeps = false;  ///< a contact, when it began to wait
};

/// A strict total order: results do not depend on how the queue came about.
struct Earlier {
  bool operator()(const Waiting& a, const Waiting& b) const noexcept {
    if (a.later != b.later) return b.later;
    if (a.rank != b.rank) return a.rank < b.rank;
    return a.lower_m < b.lower_m || (a.lower_m == b.lower_m && a.node < b.node);
  }
};

/// Earliest first; where a query is worked off to its end (Schedule::exhaustive) last first: a push
/// or pop is then O(1), and what lies together in memory is worked off together.
class WaitQueue {
 public:
  WaitQueue(std::span<Waiting> storage, Schedule schedule) noexcept
      : storage_(storage), heap_(storage), schedule_(schedule) {}

  [[nodiscard]] bool empty() const noexcept { return items().empty(); }
  [[nodiscard]] std::span<const Waiting> items() const noexcept {
    return is_heap() ? heap_.items() : storage_.first(stacked_);
  }
  [[nodiscard]] const Waiting& top() const noexcept {
    return is_heap() ? heap_.top() : storage_[stacked_ - 1];
  }

  void push(const Waiting& item) noexcept {
    if (is_heap()) return heap_.push(item);
    PALPATE_ASSERT(stacked_ < storage_.size());
    storage_[stacked_++] = item;
  }
  void pop() noexcept {
    if (is_heap()) return heap_.pop();
    PALPATE_ASSERT(stacked_ > 0);
    --stacked_;
  }
  void clear() noexcept {
    heap_.clear();
    stacked_ = 0;
  }

 private:
  [[nodiscard]] bool is_heap() const noexcept { return schedule_ == Schedule::by_priority; }

  std::span<Waiting> storage_;
  MinQueue<Waiting, Earlier> heap_;
  std::size_t stacked_ = 0;
  Schedule schedule_;
};

}  // namespace palpate::levels

// SPDX-License-Identifier: GPL-3.0-or-later
// Ticks that may neither call the allocator nor touch a page for the first time: counted, not
// assumed.
#pragma once

#include <span>

#include "tests/support/baked_scene.hpp"
#include "tools/realtime/thread_counters.hpp"

namespace palpate::test {

/// @param place  sets the poses of a tick by its number
/// @param warm   ticks before counting begins: they map code and stack
/// Every third tick is cut short, of the warm ones too: code that is first run later faults or not
/// by where the loader has put it. On average there has to be more than one contact a tick.
template <class Place>
void expect_no_allocation_and_no_fault(BakedScene& scene, std::span<const Pose> poses, Place place,
                                       int warm, int ticks) {
  if (!realtime::thread_counters().allocator_calls)
    GTEST_SKIP() << "a sanitizer brings an allocator of its own";
  const auto budget_of = [](int i) {
    return i % 3 == 0 ? Budget{.units = 50, .reserve_units = i % 2 == 0 ? 0u : 500u} : Budget{};
  };
  TickResult result;
  for (int i = 0; i < warm; ++i) {
    place(i);
    ASSERT_EQ(tick(*scene.engine, poses, budget_of(i), result), Status::ok);
  }
  const realtime::ThreadCounters before = realtime::thread_counters();
  bool sound = true;
  std::size_t contacts = 0;
  for (int i = 0; i < ticks; ++i) {
    place(i);
    sound &= tick(*scene.engine, poses, budget_of(i), result) == Status::ok;
    contacts += result.contacts.size();
  }
  const realtime::ThreadCounters spent = realtime::thread_counters() - before;
  EXPECT_TRUE(sound);
  EXPECT_GT(contacts, static_cast<std::size_t>(ticks));
  EXPECT_EQ(*spent.allocator_calls, 0u);
  EXPECT_EQ(spent.minor_faults, 0u);
  EXPECT_EQ(spent.major_faults, 0u);
}

}  // namespace palpate::test

// SPDX-License-Identifier: Apache-2.0
#include "hal/ring.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace palpate::hal {
namespace {

TEST(Ring, capacity_is_rounded_up_to_a_power_of_two) {
  EXPECT_EQ(Ring<int>(0).capacity(), 1u);
  EXPECT_EQ(Ring<int>(8).capacity(), 8u);
  EXPECT_EQ(Ring<int>(9).capacity(), 16u);
}

TEST(Ring, empty_pops_nothing) {
  Ring<int> ring(4);
  std::array<int, 4> out{};
  EXPECT_EQ(ring.pop(out), 0u);
}

TEST(Ring, full_drops_the_newest_and_counts) {
  Ring<int> ring(4);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(ring.push(i), i < 4);
  EXPECT_EQ(ring.dropped(), 2u);
  std::array<int, 8> out{};
  ASSERT_EQ(ring.pop(out), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(out[static_cast<std::size_t>(i)], i);
}

TEST(Ring, order_is_kept_over_many_wraps) {
  Ring<int> ring(8);
  int pushed = 0, popped = 0;
  std::array<int, 3> out{};
  for (int round = 0; round < 1000; ++round) {
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(ring.push(pushed++));
    const std::size_t count = ring.pop(out);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(out[i], popped++);
  }
  EXPECT_EQ(pushed, popped);
  EXPECT_EQ(ring.dropped(), 0u);
}

TEST(Ring, two_threads_every_value_arrives_in_order_or_is_counted) {
  constexpr std::uint64_t kValues = 1'000'000;
  Ring<std::uint64_t> ring(256);
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kValues; ++i) ring.push(i);
    done = true;
  });
  std::uint64_t arrived = 0, last = 0;
  bool ascending = true;
  std::array<std::uint64_t, 64> out{};
  for (bool over = false; !over;) {
    over = done;  // read before the pop: what was pushed before it is then still taken
    while (const std::size_t count = ring.pop(out)) {
      for (std::size_t i = 0; i < count; ++i) {
        ascending = ascending && out[i] > last;
        last = out[i];
      }
      arrived += count;
    }
  }
  writer.join();
  EXPECT_TRUE(ascending);
  EXPECT_EQ(arrived + ring.dropped(), kValues);
}

}  // namespace
}  // namespace palpate::hal

// SPDX-License-Identifier: Apache-2.0
#include "hal/exchange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace palpate::hal {
namespace {

/// Large enough that a copy takes many instructions: a torn one shows as words that differ.
struct Block {
  std::array<std::uint64_t, 24> words{};
};

/// Writes, or reads in vain, before the core is given up. That lets the other thread run where both
/// share one; done often, it waits for whatever else the machine has to do.
constexpr int kPatience = 200;

Block block_of(std::uint64_t value) {
  Block block;
  block.words.fill(value);
  return block;
}

bool is_whole(const Block& block) {
  return std::all_of(block.words.begin(), block.words.end(),
                     [&](std::uint64_t w) { return w == block.words[0]; });
}

TEST(Mailbox, before_the_first_write_reads_nothing) {
  Mailbox<int> box;
  int value = 7;
  EXPECT_FALSE(box.read(value));
  EXPECT_EQ(value, 7);
}

TEST(Mailbox, value_is_read_once) {
  Mailbox<int> box;
  box.write(1);
  int value = 0;
  EXPECT_TRUE(box.read(value));
  EXPECT_EQ(value, 1);
  EXPECT_FALSE(box.read(value));
}

TEST(Mailbox, several_writes_newest_is_read) {
  Mailbox<int> box;
  for (int i = 1; i <= 5; ++i) box.write(i);
  int value = 0;
  EXPECT_TRUE(box.read(value));
  EXPECT_EQ(value, 5);
  EXPECT_FALSE(box.read(value));
}

TEST(Mailbox, alternating_writes_and_reads_lose_nothing) {
  Mailbox<int> box;
  for (int i = 1; i <= 1000; ++i) {
    box.write(i);
    int value = 0;
    ASSERT_TRUE(box.read(value));
    ASSERT_EQ(value, i);
  }
}

TEST(Mailbox, a_million_exchanges_between_threads_none_torn_none_older) {
  constexpr std::uint64_t kExchanges = 1'000'000;
  Mailbox<Block> box;
  std::atomic<bool> enough{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; !enough.load(std::memory_order_relaxed); ++i) {
      box.write(block_of(i));
      if (i % kPatience == 0) std::this_thread::yield();
    }
  });
  std::uint64_t last = 0, torn = 0, older = 0;
  int in_vain = 0;
  for (std::uint64_t exchanges = 0; exchanges < kExchanges;) {
    Block block;
    if (!box.read(block)) {
      if (++in_vain % kPatience == 0) std::this_thread::yield();
      continue;
    }
    ++exchanges;
    if (!is_whole(block)) ++torn;
    if (block.words[0] <= last) ++older;
    last = block.words[0];
  }
  enough = true;
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(older, 0u);
}

TEST(Mailbox, pair_of_boxes_echoes_every_value) {
  // Both directions at once, as a device and the loop use them: each side must always come to see
  // the other's newest.
  constexpr std::uint64_t kRounds = 20'000;
  Mailbox<Block> there, back;
  std::thread echo([&] {
    Block block;
    int in_vain = 0;
    while (block.words[0] < kRounds) {
      if (there.read(block)) {
        back.write(block);
      } else if (++in_vain % kPatience == 0) {
        std::this_thread::yield();
      }
    }
  });
  int in_vain = 0;
  Block answer;
  for (std::uint64_t i = 1; i <= kRounds; ++i) {
    there.write(block_of(i));
    while (answer.words[0] != i) {
      if (!back.read(answer) && ++in_vain % kPatience == 0) std::this_thread::yield();
    }
    ASSERT_TRUE(is_whole(answer));
  }
  echo.join();
}

}  // namespace
}  // namespace palpate::hal

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/clocks.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace palpate::cli {
namespace {

constexpr std::uint64_t kMillisecond_ns = 1'000'000;

TEST(ProcessorClock, does_not_count_sleep) {
  ProcessorClock clock;
  const std::uint64_t start_ns = clock.now_ns();
  const std::uint64_t wall_start_ns = wall_ns();
  const std::uint64_t thread_start_ns = processor_ns();
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  const std::uint64_t slept_ns = wall_ns() - wall_start_ns;
  const std::uint64_t passed_ns = clock.now_ns() - start_ns;
  EXPECT_GE(slept_ns, 30 * kMillisecond_ns);
  EXPECT_LE(passed_ns, processor_ns() - thread_start_ns + kMillisecond_ns);
}

TEST(ProcessorClock, counts_work_and_never_turns_back) {
  ProcessorClock clock;
  const std::uint64_t wall_start_ns = wall_ns();
  const std::uint64_t start_ns = clock.now_ns();
  const std::uint64_t thread_start_ns = processor_ns();
  std::uint64_t last_ns = start_ns;
  while (processor_ns() - thread_start_ns < 5 * kMillisecond_ns) {
    for (int i = 0; i < 100; ++i) {
      const std::uint64_t now_ns = clock.now_ns();
      ASSERT_GE(now_ns, last_ns);
      last_ns = now_ns;
    }
  }
  EXPECT_GE(last_ns - start_ns, 4 * kMillisecond_ns);
  EXPECT_LE(last_ns - start_ns, wall_ns() - wall_start_ns);
}

}  // namespace
}  // namespace palpate::cli

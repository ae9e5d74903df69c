// SPDX-License-Identifier: GPL-3.0-or-later
// The end of the loop's thread: when its priority goes, and when memory is unlocked. Both calls are
// answered here: the executable's definitions come before the C library's.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <string>
#include <vector>

#include "tools/realtime/realtime_thread.hpp"

namespace {

/// What was called, in order, by whichever thread.
std::vector<std::string>& calls() {
  static std::vector<std::string> all;
  return all;
}

}  // namespace

extern "C" {

int mlockall(int) noexcept {
  calls().emplace_back("lock");
  return 0;
}

int munlockall() noexcept {
  calls().emplace_back("unlock");
  return 0;
}

int pthread_setschedparam(pthread_t, int policy, const sched_param*) noexcept {
  calls().emplace_back(policy == SCHED_FIFO ? "real-time" : "ordinary");
  return 0;
}
}

namespace palpate::realtime {
namespace {

using Calls = std::vector<std::string>;

TEST(EndOfTheLoop, priority_goes_first_and_memory_is_unlocked_when_the_device_has_been_stopped) {
  calls().clear();
  {
    RealtimeThread thread({}, [] { calls().emplace_back("last tick"); });
    const HostGrant grant = thread.join();
    EXPECT_TRUE(grant.memory_locked);
    calls().emplace_back("device stopped");
  }
  EXPECT_EQ(calls(),
            (Calls{"lock", "real-time", "last tick", "ordinary", "device stopped", "unlock"}));
}

TEST(EndOfTheLoop, memory_is_unlocked_after_a_thread_that_nobody_waited_for) {
  calls().clear();
  {
    const RealtimeThread thread({}, [] { calls().emplace_back("last tick"); });
  }
  EXPECT_EQ(calls(), (Calls{"lock", "real-time", "last tick", "ordinary", "unlock"}));
}

}  // namespace
}  // namespace palpate::realtime

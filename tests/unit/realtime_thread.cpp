// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/realtime_thread.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <vector>

#include "tools/realtime/thread_counters.hpp"

namespace palpate::realtime {
namespace {

TEST(ThreadCounters, every_way_to_allocate_is_counted) {
  const ThreadCounters before = thread_counters();
  if (!before.allocator_calls) GTEST_SKIP() << "this build has an allocator of its own";
  const auto calls_of = [](auto work) {
    const ThreadCounters start = thread_counters();
    work();
    return *(thread_counters() - start).allocator_calls;
  };
  // Volatile, so that no pair of calls is optimised away.
  void* volatile block = nullptr;
  EXPECT_EQ(calls_of([] {}), 0u);
  EXPECT_EQ(calls_of([&] { block = std::malloc(10); }), 1u);
  EXPECT_EQ(calls_of([&] { block = std::realloc(block, 100'000); }), 1u);
  EXPECT_EQ(calls_of([&] { std::free(block); }), 1u);
  EXPECT_EQ(calls_of([&] { block = std::calloc(3, 7); }), 1u);
  EXPECT_EQ(calls_of([&] { std::free(block); }), 1u);
  EXPECT_GE(calls_of([&] { block = std::aligned_alloc(64, 128); }), 1u);
  std::free(block);
  EXPECT_GE(calls_of([&] {
              void* p = nullptr;
              if (posix_memalign(&p, 64, 128) == 0) block = p;
            }),
            1u);
  std::free(block);
  EXPECT_EQ(calls_of([&] {
              int* volatile p = new int(3);
              delete p;
            }),
            2u);
  EXPECT_GE(calls_of([] { std::vector<std::string> grow(5, std::string(100, 'x')); }), 12u);
}

TEST(ThreadCounters, bad_alignment_is_refused_as_the_standard_says) {
  if (!thread_counters().allocator_calls) GTEST_SKIP() << "this build has an allocator of its own";
  void* p = nullptr;
  EXPECT_EQ(posix_memalign(&p, 24, 8), EINVAL);
  EXPECT_EQ(posix_memalign(&p, 2, 8), EINVAL);
}

TEST(ThreadCounters, first_touch_of_a_page_is_a_minor_fault) {
  constexpr std::size_t kPages = 16, kPage = 4096;
  void* const memory =
      ::mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  ASSERT_EQ(::madvise(memory, kPages * kPage, MADV_NOHUGEPAGE), 0);
  volatile char* const bytes = static_cast<char*>(memory);
  const ThreadCounters before = thread_counters();
  for (std::size_t i = 0; i < kPages; ++i) bytes[i * kPage] = 1;
  EXPECT_GE((thread_counters() - before).minor_faults, kPages);
  ::munmap(memory, kPages * kPage);
}

TEST(RealtimeThread, runs_its_body_once_and_says_what_it_was_granted) {
  int runs = 0;
  RealtimeThread thread({}, [&] { ++runs; });
  const HostGrant grant = thread.join();
  EXPECT_TRUE(thread.finished());
  EXPECT_EQ(runs, 1);
  if (grant.scheduler == "SCHED_OTHER" || !grant.memory_locked) {
    EXPECT_FALSE(grant.notes.empty());
  }
}

TEST(RealtimeThread, ordinary_priority_on_request) {
  RealtimeOptions options;
  options.fifo_priority = 0;
  EXPECT_EQ(RealtimeThread(options, [] {}).join().scheduler, "SCHED_OTHER");
}

TEST(RealtimeThread, processor_that_is_not_there_is_noted_and_the_body_runs) {
  RealtimeOptions options;
  options.cpu = 1'000'000;
  bool ran = false;
  const HostGrant grant = RealtimeThread(options, [&] { ran = true; }).join();
  EXPECT_TRUE(ran);
  ASSERT_FALSE(grant.notes.empty());
}

TEST(RealtimeThread, memory_that_exists_by_then_does_not_fault) {
  if (!thread_counters().allocator_calls) GTEST_SKIP() << "sanitizers do not lock memory";
  constexpr std::size_t kBytes = std::size_t(1) << 22, kPage = 4096;
  // Fresh from the system and never touched.
  void* const memory =
      ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  volatile char* const bytes = static_cast<char*>(memory);
  ThreadCounters counted;
  const HostGrant grant = RealtimeThread({}, [&] {
                            const ThreadCounters before = thread_counters();
                            for (std::size_t i = 0; i < kBytes; i += kPage) bytes[i] = 1;
                            counted = thread_counters() - before;
                          }).join();
  ::munmap(memory, kBytes);
  if (!grant.memory_locked) GTEST_SKIP() << "memory could not be locked";
  EXPECT_EQ(counted.minor_faults + counted.major_faults, 0u);
}

}  // namespace
}  // namespace palpate::realtime

// SPDX-License-Identifier: Apache-2.0
// Regions that are felt, more of them than there is time for: who stays, and how the others go.
#include "rt_core/regions/crowd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "rt_core/regions/work.hpp"

namespace palpate::test {
namespace {

using regions::Crowd;

constexpr std::uint32_t kWidth = image::kRegionWidth;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kLong = 64;  // ticks: longer than shares and presences take

/// Regions of full nodes, all felt, at half of delta.
struct Surface {
  explicit Surface(std::uint32_t nodes)
      : regions(kWidth * nodes), witnesses(kWidth * nodes), absence(kWidth * nodes) {
    for (std::uint32_t i = 0; i < regions.size(); ++i) {
      regions[i].parent = i / kWidth;
      regions[i].slot = i % kWidth;
      witnesses[i] = {i, i, 0.5f};
      active.push_back({.way = {}, .state = i, .region = i, .pair = 0});
    }
    view.regions = regions;
    pair.image_a = &view;
    pair.delta = 1;
    memory.pairs = {&pair, 1};
    memory.witnesses = witnesses;
    memory.crowd.absence = absence;
  }

  void thin_out(double most, int ticks = kLong) {
    for (int i = 0; i < ticks; ++i) regions::thin_out(memory, active, most);
  }
  void thin_out_in_time_for(std::uint64_t contacts) {
    constexpr std::uint64_t kContact_ns = 512;
    TailTime tail;
    for (int i = 0; i < kLong; ++i) tail.learn(kContact_ns, 0);
    for (int i = 0; i < kLong; ++i) tail.learn(kContact_ns * 1000, 996);
    const Budget budget{.clock_ns = [](void*) -> std::uint64_t { return 0; },
                        .deadline_ns = 2 * tail.expected_ns(contacts)};
    memory.active = active;
    for (int i = 0; i < kLong; ++i) {
      Meter meter(budget, tail);
      regions::Work work(memory, {}, meter);
      work.count = static_cast<std::uint32_t>(active.size());
      regions::thin_out(work);
    }
  }
  std::size_t felt() const {
    return static_cast<std::size_t>(
        std::count_if(absence.begin(), absence.end(), [](float a) { return a < 1; }));
  }

  std::vector<image::Region> regions;
  std::vector<regions::Witness> witnesses;
  std::vector<float> absence;
  std::vector<regions::Active> active;
  ImageView view;
  levels::PairState pair;
  regions::QueryMemory memory;
};

TEST(RegionsCrowd, all_are_felt_where_there_is_time_for_all) {
  Surface s(4);
  for (const double most : {kInfinity, 64.0, 52.0}) {  // a quarter more is let pass
    s.thin_out(most);
    for (const float absence : s.absence) EXPECT_EQ(absence, 0);
  }
}

TEST(RegionsCrowd, no_more_are_felt_than_there_is_time_for_by_a_quarter) {
  for (const double most : {40.0, 20.0, 9.0}) {
    Surface s(4);
    s.thin_out(most);
    EXPECT_LE(static_cast<double>(s.felt()), 1.25 * most);
    EXPECT_GE(static_cast<double>(s.felt()), 0.5 * most);
  }
}

TEST(RegionsCrowd, who_stays_is_spread_evenly) {
  Surface s(4);
  s.thin_out(16);
  for (std::uint32_t i = 0; i < s.witnesses.size(); i += 8) {
    const auto here = std::count_if(s.absence.begin() + i, s.absence.begin() + i + 8,
                                    [](float absence) { return absence < 1; });
    EXPECT_GE(here, 1) << i;
    EXPECT_LE(here, 3) << i;
  }
}

TEST(RegionsCrowd, of_every_node_one_stays_whichever_is_felt) {
  for (std::uint32_t alone = 0; alone < kWidth; ++alone) {
    Surface s(2);
    for (std::uint32_t i = 0; i < kWidth; ++i) {
      if (i != alone) s.witnesses[i].distance = 2;  // not felt
    }
    s.thin_out(0);
    EXPECT_EQ(s.absence[alone], 0) << alone;
    // What is not felt is there when it comes near, but beside the one that is to stay.
    EXPECT_EQ(s.felt(), (alone == 0 ? 1 : kWidth) + 1) << alone;
  }
}

/// It would only go again, and take time meanwhile.
TEST(RegionsCrowd, what_comes_near_beside_one_that_stays_is_left_out_from_the_start) {
  Surface s(8);
  for (std::uint32_t i = 0; i < s.witnesses.size(); ++i) {
    if (i % 2 == 1) s.witnesses[i].distance = 2;  // not felt
  }
  constexpr double kMost = 16;
  s.thin_out(kMost);
  for (regions::Witness& witness : s.witnesses) witness.distance = 0.9f;
  for (int i = 0; i < kLong; ++i) {
    s.thin_out(kMost, 1);
    EXPECT_LE(static_cast<double>(s.felt()), 1.25 * kMost) << i;
  }
}

TEST(RegionsCrowd, too_many_are_as_few_as_there_is_time_for_as_soon_as_they_have_gone) {
  for (const double most : {100.0, 64.0, 40.0}) {
    Surface s(16);
    s.thin_out(most, 16 + 1);
    EXPECT_LE(static_cast<double>(s.felt()), 1.25 * most);
    EXPECT_GE(static_cast<double>(s.felt()), 0.75 * most);
  }
}

TEST(RegionsCrowd, what_crosses_stays_and_does_not_count) {
  Surface s(4);
  for (std::uint32_t i = 0; i < s.witnesses.size(); i += 2) s.witnesses[i].distance = 0;
  s.thin_out(32);
  EXPECT_EQ(s.felt(), s.witnesses.size());
  s.thin_out(-1);
  EXPECT_EQ(s.felt(), s.witnesses.size() / 2 + 4);
}

TEST(RegionsCrowd, what_was_left_out_is_there_four_ticks_after_it_has_crossed) {
  Surface s(4);
  s.thin_out(10);
  for (regions::Witness& witness : s.witnesses) witness.distance = 0;
  s.thin_out(10, 3);
  EXPECT_GT(*std::max_element(s.absence.begin(), s.absence.end()), 0);
  s.thin_out(10, 1);
  for (const float absence : s.absence) EXPECT_EQ(absence, 0);
}

TEST(RegionsCrowd, nobody_comes_in_less_than_sixteen_ticks_or_goes_unless_far_too_many_are_felt) {
  for (const auto& [most, fastest] : {std::pair(48.0, 1.0f / 16), std::pair(10.0, 1.0f / 4)}) {
    Surface s(4);
    for (int i = 0; i < 2 * kLong; ++i) {
      const std::vector<float> before = s.absence;
      s.thin_out(i < kLong ? most : kInfinity, 1);
      for (std::size_t k = 0; k < before.size(); ++k) {
        EXPECT_LE(s.absence[k] - before[k], fastest);
        EXPECT_LE(before[k] - s.absence[k], 1.0f / 16);
      }
    }
    for (const float absence : s.absence) EXPECT_EQ(absence, 0);
    EXPECT_EQ(s.memory.crowd.share, Crowd::kAll);
  }
}

TEST(RegionsCrowd, far_too_many_go_within_four_ticks) {
  Surface s(16);
  s.thin_out(100, 1 + 1 + 4);  // who stays is told by the first, how fast by the second
  EXPECT_LE(static_cast<double>(s.felt()), 1.25 * 100);
}

TEST(RegionsCrowd, time_that_wavers_changes_nobody) {
  Surface s(16);
  s.thin_out(100);
  const std::uint32_t share = s.memory.crowd.share;
  for (int i = 0; i < kLong; ++i) {
    s.thin_out(i % 2 == 0 ? 92 : 108, 1);
    EXPECT_EQ(s.memory.crowd.share, share);
  }
}

TEST(RegionsCrowd, where_searches_do_not_keep_up_fewer_are_felt_than_there_is_time_for) {
  const auto felt = [](std::uint64_t in_time, bool lagged) {
    Surface s(32);
    s.memory.pursuit.lagged = lagged;
    s.thin_out_in_time_for(in_time);
    return static_cast<double>(s.felt());
  };
  EXPECT_EQ(felt(500, false), 512);
  EXPECT_NEAR(felt(500, true), std::sqrt(128.0 * 500), 0.25 * 253);
  for (const std::uint64_t few : {60u, 120u}) EXPECT_EQ(felt(few, true), felt(few, false));
}

TEST(RegionsCrowd, all_are_gathered_at_once) {
  Surface s(4);
  s.thin_out(10);
  s.memory.crowd.gather_all();
  EXPECT_EQ(s.memory.crowd.share, Crowd::kAll);
  EXPECT_EQ(s.memory.crowd.felt, 0);
  for (const float absence : s.absence) EXPECT_EQ(absence, 0);
}

}  // namespace
}  // namespace palpate::test

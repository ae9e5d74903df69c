// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/feed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "../support/virtual_loop.hpp"
#include "tools/realtime/tapped_query.hpp"

namespace palpate::live {
namespace {

/// A frame as a page reads it.
struct Read {
  std::vector<double> head;
  std::vector<float> rest;
  [[nodiscard]] std::size_t samples() const { return static_cast<std::size_t>(head[0]); }
  [[nodiscard]] float sample(std::size_t i, std::size_t what) const { return rest[8 * i + what]; }
};

Read next(const Feed& feed, std::uint64_t& seen) {
  std::vector<std::byte> bytes;
  feed.frame(seen, bytes);
  Read out;
  out.head.resize(kHeadNumbers);
  std::memcpy(out.head.data(), bytes.data(), 8 * kHeadNumbers);
  out.rest.resize((bytes.size() - 8 * kHeadNumbers) / 4);
  std::copy_n(bytes.begin() + 8 * kHeadNumbers, 4 * out.rest.size(),
              std::as_writable_bytes(std::span(out.rest)).begin());
  return out;
}

class LiveFeed : public ::testing::Test {
 protected:
  /// A tick that is due in a period.
  void tick(std::uint64_t period, float force_N = 0, std::uint16_t faults = 0) {
    realtime::TraceRecord record;
    record.tick = ticks_++;
    record.time_ns = 1'000'000 * period;
    record.sent_force_N = {0, 0, force_N};
    record.tick_ns = 50'000;
    record.faults = faults;
    ASSERT_TRUE(tap_.records.push(record));
  }

  realtime::LiveTap tap_;
  std::vector<hal::mock::Lead> led_;
  Feed feed_{
      tap_, 1000, {{1, 0, 0}, {}}, [this](const hal::mock::Lead& lead) { led_.push_back(lead); }};
  std::uint64_t ticks_ = 0;
  std::uint64_t seen_ = 0;
};

TEST_F(LiveFeed, before_the_first_tick_the_tool_is_at_its_start) {
  const Read frame = next(feed_, seen_);
  EXPECT_EQ(frame.samples(), 0u);
  EXPECT_EQ(frame.head[29], 0);
  EXPECT_TRUE(std::isnan(frame.head[14]));
  EXPECT_EQ(frame.head[35], 1);  // w
}

TEST_F(LiveFeed, page_gets_each_sample_once_with_its_peaks) {
  for (std::uint64_t i = 0; i < 10; ++i) tick(i, i == 4 ? 2.0f : 0.5f);
  feed_.update();
  const Read frame = next(feed_, seen_);
  ASSERT_EQ(frame.samples(), 5u);  // two ticks each
  EXPECT_FLOAT_EQ(frame.sample(2, 2), 2.0f);
  EXPECT_FLOAT_EQ(frame.sample(3, 2), 0.5f);
  EXPECT_FLOAT_EQ(frame.sample(0, 5), 50.0f);
  EXPECT_EQ(frame.head[7], 9);
  EXPECT_EQ(next(feed_, seen_).samples(), 0u);
  std::uint64_t other_page = 0;
  EXPECT_EQ(next(feed_, other_page).samples(), 5u);
}

TEST_F(LiveFeed, page_that_was_away_gets_the_strip_and_no_more) {
  for (std::uint64_t i = 0; i < 7000; ++i) {
    tick(i);
    if (i % 1000 == 0) feed_.update();
  }
  feed_.update();
  EXPECT_EQ(next(feed_, seen_).samples(), static_cast<std::size_t>(kStrip_s * kSamples_Hz));
}

TEST_F(LiveFeed, missed_periods_and_faults_are_marked_once) {
  tick(0);
  tick(1);
  tick(5);  // three periods without a tick
  tick(6);
  tick(7, 0, 4);
  tick(8, 0, 4);
  tick(9, 0, 4);
  tick(10, 0, 4);
  feed_.update();
  const Read frame = next(feed_, seen_);
  ASSERT_EQ(frame.samples(), 4u);
  EXPECT_EQ(frame.head[8], 3);
  EXPECT_EQ(frame.head[5], 4);
  EXPECT_EQ(frame.sample(0, 7), 0);
  EXPECT_EQ(frame.sample(1, 7), float(kMissed));
  EXPECT_EQ(frame.sample(2, 7), float(kFault));
  EXPECT_EQ(frame.sample(3, 7), 0);
}

TEST_F(LiveFeed, lead_is_in_world_axes_and_nonsense_disconnects) {
  EXPECT_TRUE(feed_.message(encode_lead({true, {{0.5, 0, 0}, {}}})));
  ASSERT_EQ(led_.size(), 1u);
  EXPECT_EQ(led_[0].to.position_m, (Vec3d{1.5, 0, 0}));
  EXPECT_FALSE(feed_.message({}));
  ASSERT_EQ(led_.size(), 1u);
  feed_.left();
  EXPECT_FALSE(led_.back().held);
  Feed deaf(tap_, 1000, {}, {});
  EXPECT_FALSE(deaf.message(encode_lead({})));
}

TEST_F(LiveFeed, end_is_said) {
  feed_.end();
  feed_.update();
  EXPECT_EQ(next(feed_, seen_).head[3], 1);
}

TEST(TappedQuery, every_nth_answer_is_shown_and_none_changed) {
  realtime::LiveTap tap;
  realtime::test::QueryOf wall(realtime::test::wall(100));
  realtime::TappedQuery tapped(wall, tap.ticks, 3, {}, {0, 0, 1});
  TickResult result;
  realtime::LiveTick shown;
  const Pose inside{{0, 0, -0.5}, {}};
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(tapped.tick(inside, {}, result), palpate::Status::ok);
    EXPECT_EQ(result.wrench.force_N.z, 50);
    EXPECT_FALSE(tap.ticks.read(shown));
  }
  ASSERT_EQ(tapped.tick(inside, {}, result), palpate::Status::ok);
  ASSERT_TRUE(tap.ticks.read(shown));
  EXPECT_EQ(shown.found, 1u);
  EXPECT_EQ(shown.shown, 1u);
  EXPECT_EQ(shown.contacts[0].centre_m[2], -1);  // from the view's origin
  EXPECT_EQ(shown.tool.position_m, inside.position_m);
}

TEST(TappedQuery, of_very_many_contacts_some_are_shown_from_all_over) {
  static std::vector<Contact> contacts(1000);
  for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i].distance_m = double(i);
  realtime::test::QueryOf many([](const Pose&, const Budget&, TickResult& out) {
    out.contacts = contacts;
    return palpate::Status::ok;
  });
  contacts[0].weight = 0.5;
  Settings settings;
  settings.stiffness_N_per_m = 100;
  settings.delta_m = 0.01;
  realtime::LiveTap tap;
  realtime::TappedQuery tapped(many, tap.ticks, 1, settings, {});
  TickResult result;
  ASSERT_EQ(tapped.tick({}, {}, result), palpate::Status::ok);
  realtime::LiveTick shown;
  ASSERT_TRUE(tap.ticks.read(shown));
  EXPECT_EQ(shown.found, 1000u);
  EXPECT_EQ(shown.shown, realtime::kMostLiveContacts);
  EXPECT_EQ(shown.contacts[0].distance_m, 0);
  EXPECT_FLOAT_EQ(shown.contacts[0].force_N, 0.5f);
  EXPECT_EQ(shown.contacts[1].force_N, 0);
  EXPECT_GT(shown.contacts[realtime::kMostLiveContacts - 1].distance_m, 980);
}

}  // namespace
}  // namespace palpate::live

// SPDX-License-Identifier: GPL-3.0-or-later
// An engine whose memory was copied goes on as if nothing had happened.
#include <gtest/gtest.h>

#include <cstring>

#include "rt_core/workspace.hpp"
#include "tests/support/two_balls.hpp"

namespace palpate::test {
namespace {

Pose slide(double i) {
  return {{1.75 + 0.02 * std::sin(0.2 * i), 0.3 * std::sin(0.03 * i), 0.004 * i},
          turn({0.01 * i, 0.004 * i, 0})};
}

const Limits kLimits{.nodes = 1u << 14};

void expect_same_bits(const TickResult& r, const TickResult& s) {
  ASSERT_EQ(std::memcmp(&r.wrench, &s.wrench, sizeof r.wrench), 0);
  ASSERT_EQ(r.contacts.size(), s.contacts.size());
  ASSERT_EQ(r.queries, s.queries);
  ASSERT_EQ(r.front_nodes, s.front_nodes);
  ASSERT_EQ(r.certificate.error_bound_m, s.certificate.error_bound_m);
}

class EngineRestore : public testing::TestWithParam<EngineKind> {};

// With equal images at another address, and nothing left at the first one.
TEST_P(EngineRestore, continues_with_the_same_bits_at_another_address) {
  struct Case {
    std::uint64_t units;
    double pace;  ///< slow: searches go on from tick to tick
  };
  for (const auto [units, pace] : {Case{60, 1}, Case{60, 0.05}, Case{1000000, 1}}) {
    const Settings settings{.engine = GetParam(), .delta_m = 0.05, .s0 = 0.01};
    BakedScene through({two_balls().a.view, two_balls().b.view}, {{0, 1}}, settings, kLimits);
    BakedScene halfway({two_balls().a.view, two_balls().b.view}, {{0, 1}}, settings, kLimits);
    for (int i = 0; i < 30; ++i) {
      const Pose poses[2] = {slide(pace * i), {}};
      expect_same_bits(tick_or_fail(*through.engine, poses, {.units = units}),
                       tick_or_fail(*halfway.engine, poses, {.units = units}));
    }
    const AlignedMemory copy(halfway.memory.size);
    std::memcpy(copy.data.get(), halfway.memory.data.get(), copy.size);
    std::memset(halfway.memory.data.get(), 0xa5, copy.size);
    std::vector<AlignedMemory> images;
    std::vector<ImageView> views(2);
    for (const BakedBody* body : {&two_balls().a, &two_balls().b}) {
      images.emplace_back(body->bytes->size);
      std::memcpy(images.back().data.get(), body->bytes->data.get(), body->bytes->size);
      ASSERT_EQ(validate(images.back().span(), views[images.size() - 1]), Status::ok);
    }
    const std::vector<BodyPair> pairs{{0, 1}};
    Engine* engine = nullptr;
    ASSERT_EQ(restore({views, pairs, 0}, kLimits, GetParam(), copy.span(), engine), Status::ok);
    for (int i = 30; i < 80; ++i) {
      const Pose poses[2] = {slide(pace * i), {}};
      expect_same_bits(tick_or_fail(*through.engine, poses, {.units = units}),
                       tick_or_fail(*engine, poses, {.units = units}));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, EngineRestore,
                         testing::Values(EngineKind::levels, EngineKind::regions),
                         [](const auto& tested) {
                           return tested.param == EngineKind::levels ? "levels" : "regions";
                         });

TEST(EngineRestoreRefusals, what_the_copy_was_not_made_for_is_refused) {
  const Settings settings{.delta_m = 0.05};
  BakedScene scene({two_balls().a.view, two_balls().b.view}, {{0, 1}}, settings, kLimits);
  Engine* engine = nullptr;
  const std::span<std::byte> memory = scene.memory.span();
  const auto again = [&](const Scene& other, const Limits& limits) {
    return restore(other, limits, EngineKind::levels, memory, engine);
  };
  EXPECT_EQ(again(scene.scene(), kLimits), Status::ok);
  const std::vector<ImageView> swapped{two_balls().b.view, two_balls().a.view};
  EXPECT_EQ(again({swapped, scene.pairs, 0}, kLimits), Status::bad_argument);
  EXPECT_EQ(again({scene.bodies, scene.pairs, 1}, kLimits), Status::bad_argument);
  Limits fewer = kLimits;
  --fewer.nodes;
  EXPECT_EQ(again(scene.scene(), fewer), Status::bad_argument);
  EXPECT_EQ(
      restore(scene.scene(), kLimits, EngineKind::levels, memory.first(memory.size() - 64), engine),
      Status::not_enough_memory);
  std::memset(memory.data(), 0, memory.size());
  EXPECT_EQ(again(scene.scene(), kLimits), Status::bad_argument);
}

}  // namespace
}  // namespace palpate::test

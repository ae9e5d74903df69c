// SPDX-License-Identifier: GPL-3.0-or-later
// The exact force is that of the surfaces, whichever engine asks for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "host_bake/models/models.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/effort.hpp"

namespace palpate::test {
namespace {

constexpr int kTicks = 1500;

/// A tool pressed into another body and led over it, held at a depth that swings.
struct Press {
  const char* tool;
  const char* other;
  Vec3d from_m;      ///< where it begins, apart
  Vec3d way_out;     ///< unit: along it the depth is held
  Vec3d swing_m[2];  ///< how far it is led, in two rhythms
  double deepest_m;
  double most_step_N;  ///< between two ticks
};

constexpr Press kPresses[] = {
    {"golf_club",
     "golf_ball",
     {0, -0.0268, -0.004},
     {0, -1, 0},
     {{3e-3, 0, 0}, {0, 0, 3e-3}},
     4e-4,
     0.1},
    {"ellipsoid", "golf_ball", {0, 0, 0.0435}, {0, 0, 1}, {{2e-3, 0, 0}, {0, 3e-3, 0}}, 5e-4, 0.06},
    {"jaw_upper", "jaw_lower", {0, 0, 0.0015}, {0, 0, 1}, {{1e-3, 0, 0}, {0, 1e-3, 0}}, 1e-4, 0.2},
};

Vec3d led(const Press& press, int tick) {
  constexpr double kSlow = 0.004, kFast = 0.0061;  // rad a tick
  return press.from_m + std::sin(kSlow * tick) * press.swing_m[0] +
         std::sin(kFast * tick) * press.swing_m[1];
}

double depth(const Press& press, int tick) {
  return -0.5 * press.deepest_m * (1 - std::cos(0.01 * tick));
}

struct Felt {
  double most_N = 0;
  double difference_N = 0;  ///< of both engines, the largest
  double step_N = 0;        ///< largest change in a tick
  int overlapping = 0;
};

Felt feel(const Press& press) {
  const BakedBody tool(bake::make_model(press.tool, 6000), bake::ForEngine::both);
  const BakedBody other(bake::make_model(press.other, 6000), bake::ForEngine::both);
  Settings settings;
  settings.exact = true;
  BakedScene levels({tool.view, other.view}, {{0, 1}}, settings);
  settings.engine = EngineKind::regions;
  BakedScene regions({tool.view, other.view}, {{0, 1}}, settings);
  Felt felt;
  double offset_m = 0;
  Vec3d before_N;
  for (int t = 0; t < kTicks; ++t) {
    const Pose poses[2] = {{led(press, t) + offset_m * press.way_out, {}}, {}};
    const TickResult one = tick_or_fail(*regions.engine, poses);
    const TickResult two = tick_or_fail(*levels.engine, poses);
    constexpr double kStep_m = 3e-5;
    const double distance_m = one.contacts.empty() ? settings.delta_m : one.min_distance_m;
    const double off_m = distance_m - depth(press, t);
    offset_m -= std::clamp(off_m, -kStep_m, kStep_m);
    const Vec3d now_N = one.wrench.force_N;
    if (t > 0) felt.step_N = std::max(felt.step_N, norm(now_N - before_N));
    before_N = now_N;
    felt.overlapping += distance_m < 0 ? 1 : 0;
    felt.most_N = std::max(felt.most_N, norm(now_N));
    felt.difference_N = std::max(felt.difference_N, norm(two.wrench.force_N - now_N));
  }
  return felt;
}

void PrintTo(const Press& press, std::ostream* os) { *os << press.tool; }

class Overlap : public testing::TestWithParam<Press> {};

TEST_P(Overlap, is_felt_alike_by_both_engines) {
  const Press& press = GetParam();
  const Felt felt = feel(press);
  RecordProperty("step_mN", std::to_string(1e3 * felt.step_N));
  EXPECT_GT(felt.overlapping, kTicks / 2);
  EXPECT_LT(felt.difference_N, 1e-9 * felt.most_N);
  EXPECT_LT(felt.step_N, press.most_step_N);
}

// What is kept from tick to tick tells where to look first, never what is left out.
TEST(ExactForce, is_that_of_a_cold_start) {
  const BakedBody tool(bake::make_model("jaw_upper", 6000), bake::ForEngine::regions);
  const BakedBody other(bake::make_model("jaw_lower", 6000), bake::ForEngine::regions);
  Settings settings;
  settings.exact = true;
  settings.engine = EngineKind::regions;
  BakedScene warm({tool.view, other.view}, {{0, 1}}, settings);
  for (int t = 0; t < 200; ++t) {
    const Pose poses[2] = {
        {{2e-3 * std::sin(.021 * t), 2e-3 * std::sin(.034 * t), 6e-4 * std::cos(.1 * t)}, {}}, {}};
    const Wrench w = tick_or_fail(*warm.engine, poses).wrench;
    BakedScene cold({tool.view, other.view}, {{0, 1}}, settings);
    const Wrench c = tick_or_fail(*cold.engine, poses).wrench;
    EXPECT_LT(norm(w.force_N - c.force_N), 1e-9 + 1e-9 * norm(c.force_N)) << t;
    EXPECT_LT(norm(w.torque_Nm - c.torque_Nm), 1e-9 + 1e-9 * norm(c.torque_Nm)) << t;
  }
}

INSTANTIATE_TEST_SUITE_P(Presses, Overlap, testing::ValuesIn(kPresses, kPresses + effort(3, 1)),
                         [](const auto& tested) { return std::string(tested.param.tool); });

}  // namespace
}  // namespace palpate::test

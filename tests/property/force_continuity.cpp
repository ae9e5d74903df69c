// SPDX-License-Identifier: GPL-3.0-or-later
// What a change of level or of budget does to the force: jaws ground on each other, so that levels
// switch and the budget ends refinement in every tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>

#include "host_bake/models/models.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/ground.hpp"
#include "tools/realtime/engine_query.hpp"
#include "tools/realtime/steady_query.hpp"

namespace palpate::test {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr std::uint64_t kUnlimited = Budget{}.units;

const BakedBody& upper() {
  static const BakedBody b(bake::make_model("jaw_upper", 6000), bake::ForEngine::both);
  return b;
}
const BakedBody& lower() {
  static const BakedBody b(bake::make_model("jaw_lower", 6000), bake::ForEngine::both);
  return b;
}

struct Steps {
  double force_N = 0, torque_Nm = 0;  // the largest
};

Steps largest_steps(const Settings& settings, std::uint64_t units, double speed_m_per_s,
                    bool steady) {
  constexpr int kTicks = 400;
  BakedScene scene({upper().view, lower().view}, {{0, 1}}, settings);
  const Pose poses[2] = {};
  realtime::EngineQuery contacts(*scene.engine, poses, 0);
  realtime::SteadyQuery steadied(contacts, {}, settings.stiffness_N_per_m, kPeriod_s);
  realtime::ContactQuery& query =
      steady ? static_cast<realtime::ContactQuery&>(steadied) : contacts;
  Steps steps;
  Wrench before;
  for (int i = 0; i < kTicks; ++i) {
    TickResult r;
    EXPECT_EQ(query.tick(ground(speed_m_per_s, i), {.units = units}, r), Status::ok);
    if (i > 0) {
      const double step_N = norm(r.wrench.force_N - before.force_N);
      steps.force_N = std::max(steps.force_N, step_N);
      steps.torque_Nm = std::max(steps.torque_Nm, norm(r.wrench.torque_Nm - before.torque_Nm));
    }
    before = r.wrench;
  }
  return steps;
}

constexpr double kSpeeds[] = {0.1, 0.3};  // in m/s

class GroundJaws : public testing::TestWithParam<double> {};

TEST_P(GroundJaws, exact_force_steps_at_most_as_far_as_two_and_a_half_stiffnesses_of_the_motion) {
  const Settings settings{.exact = true};
  const Steps exact = largest_steps(settings, kUnlimited, GetParam(), false);
  EXPECT_LE(exact.force_N, 2.5 * settings.stiffness_N_per_m * GetParam() * kPeriod_s);
}

TEST_P(GroundJaws, steadied_force_steps_at_most_half_as_far_again_as_the_exact_one) {
  const double speed_m_per_s = GetParam();
  const Steps exact = largest_steps({.exact = true}, kUnlimited, speed_m_per_s, false);
  const Settings settings[] = {
      {.s0 = 0.005}, {.s0 = 0.015}, {.s0 = 0.05}, {.s0 = 1e3, .kappa = 0.1}};
  for (const Settings& setting : std::span(settings).first(effort(4u, 2u))) {
    for (const std::uint64_t units : {kUnlimited, std::uint64_t{200}, std::uint64_t{60}}) {
      const Steps felt = largest_steps(setting, units, speed_m_per_s, true);
      SCOPED_TRACE("s0 " + std::to_string(setting.s0) + ", " + std::to_string(units) + " units");
      EXPECT_LE(felt.force_N, 1.5 * exact.force_N);
      EXPECT_LE(felt.torque_Nm, 1.5 * exact.torque_Nm);
    }
  }
}

TEST_P(GroundJaws, force_steps_less_than_twice_as_far_without_steadying_where_no_budget_ends_it) {
  const Steps exact = largest_steps({.exact = true}, kUnlimited, GetParam(), false);
  for (const double s0 : {0.005, 0.05}) {
    const Steps felt = largest_steps({.s0 = s0}, kUnlimited, GetParam(), false);
    // Where bodies begin to overlap the surfaces take the place of simplified contacts; what is
    // not proved misses vertices that do not face the surface nearest to them.
    EXPECT_LE(felt.force_N, 2 * exact.force_N) << "s0 " << s0;
  }
}

TEST_P(GroundJaws, regions_step_so_too_and_without_steadying_where_a_budget_nearly_does) {
  constexpr EngineKind kRegions = EngineKind::regions;
  const Steps exact =
      largest_steps({.engine = kRegions, .exact = true}, kUnlimited, GetParam(), false);
  const Steps felt = largest_steps({.engine = kRegions}, 2500, GetParam(), false);
  EXPECT_LE(felt.force_N, 1.85 * exact.force_N);
  for (const std::uint64_t units : {2500u, 1700u, 1000u, 750u, 500u, 300u, 200u}) {
    const Steps steadied = largest_steps({.engine = kRegions}, units, GetParam(), true);
    EXPECT_LE(steadied.force_N, 1.5 * exact.force_N) << units << " units";
    EXPECT_LE(steadied.torque_Nm, 1.5 * exact.torque_Nm) << units << " units";
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, GroundJaws, testing::ValuesIn(kSpeeds, kSpeeds + effort(2, 1)),
                         [](const auto& tested) {
                           return std::to_string(static_cast<int>(1000 * tested.param)) +
                                  "_mm_per_s";
                         });

TEST(GroundJawsSlowly, without_steadying_it_is_worse_where_a_budget_ends_it) {
  constexpr std::uint64_t kFew = 60;
  const Settings simplified{.s0 = 0.05};
  EXPECT_GT(largest_steps(simplified, kFew, 0.1, false).force_N,
            1.1 * largest_steps(simplified, kFew, 0.1, true).force_N);
}

}  // namespace
}  // namespace palpate::test

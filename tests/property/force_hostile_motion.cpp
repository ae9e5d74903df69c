// SPDX-License-Identifier: GPL-3.0-or-later
// Motions no hand should make, through engine, coupling and safety stage: bounded, finite, and well
// again when apart.
#include <gtest/gtest.h>

#include <random>

#include "tests/support/baked_scene.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"
#include "tools/realtime/coupled_query.hpp"
#include "tools/realtime/engine_query.hpp"
#include "tools/realtime/safety.hpp"

namespace palpate::test {
namespace {

using realtime::CoupledQuery;
using realtime::EngineQuery;
using realtime::LoopState;
using realtime::SafetySettings;
using realtime::SafetyStage;

constexpr double kPeriod_s = 1e-3, kMaxForce_N = 4, kMaxTorque_Nm = 0.2, kMaxPower_W = 3;
constexpr double kSlew_N_per_s = 1000, kSlew_Nm_per_s = 40;
constexpr Vec3d kFar_m{0.5, 0, 0};

/// A studded ball as the tool against a thin plate and a ring.
const BakedBody& tool_body() {
  static const BakedBody b(bumpy_ball(10, 14, 0.02), bake::ForEngine::both);
  return b;
}
const BakedBody& plate() {
  static const BakedBody b(box(0.03, 0.03, 0.0005), bake::ForEngine::both);
  return b;
}
const BakedBody& torus() {
  static const BakedBody b(ring(20, 10, 0.03, 0.008), bake::ForEngine::both);
  return b;
}

bool is_finite(const Wrench& w) {
  return std::isfinite(norm(w.force_N)) && std::isfinite(norm(w.torque_Nm));
}

/// Everything between a pose and the device.
struct Chain {
  Chain(EngineKind kind, bool coupled_virtually, Pose start)
      : scene({tool_body().view, plate().view, torus().view}, {{0, 1}, {0, 2}},
              {.engine = kind, .delta_m = 0.0005, .stiffness_N_per_m = 800}),
        contacts(*scene.engine, poses(), 0),
        coupled(contacts, {}, kPeriod_s),
        query(coupled_virtually ? static_cast<realtime::ContactQuery*>(&coupled) : &contacts),
        stage(limits(), kPeriod_s),
        before(start) {
    reading.pose = start;
    for (int i = 0; i < 400; ++i) tick(start);
    EXPECT_EQ(stage.state(), LoopState::rendering);
  }

  static std::vector<Pose> poses() { return {{}, {}, {{0, 0, 0.012}, {}}}; }
  static SafetySettings limits() {
    SafetySettings s;
    s.max_force_N = kMaxForce_N;
    s.max_torque_Nm = kMaxTorque_Nm;
    s.max_force_slew_N_per_s = kSlew_N_per_s;
    s.max_torque_slew_Nm_per_s = kSlew_Nm_per_s;
    s.max_power_W = kMaxPower_W;
    return s;
  }

  /// Sends, and looks at every limit.
  Wrench tick(const Pose& pose) {
    reading.pose = pose;
    EXPECT_TRUE(stage.accept(&reading, 0));
    const Status status = query->tick(pose, {.units = 300}, result);
    EXPECT_EQ(status, Status::ok);
    EXPECT_TRUE(is_finite(result.wrench));
    const hal::Twist twist{(1 / kPeriod_s) * (pose.position_m - before.position_m), {}};
    before = pose;
    const Wrench now = stage.command(status, result.wrench, twist);
    stage.tick_ended(0);
    EXPECT_TRUE(is_finite(now));
    EXPECT_LE(norm(now.force_N), kMaxForce_N);
    EXPECT_LE(norm(now.torque_Nm), kMaxTorque_Nm);
    EXPECT_LE(dot(now.force_N, twist.linear_m_per_s), kMaxPower_W * (1 + 1e-9));
    // Faster only where power asks for it: then the force is shorter than before.
    if (norm(now.force_N) > norm(sent.force_N)) {
      EXPECT_LE(norm(now.force_N) - norm(sent.force_N), kSlew_N_per_s * kPeriod_s * (1 + 1e-9));
    }
    sent = now;
    return now;
  }

  BakedScene scene;
  EngineQuery contacts;
  CoupledQuery coupled;
  realtime::ContactQuery* query;
  SafetyStage stage;
  hal::DeviceState reading;
  Pose before;
  TickResult result;
  Wrench sent;
};

struct Case {
  EngineKind kind;
  bool coupled;
};

class HostileMotion : public testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] Chain chain(Pose start = {kFar_m, {}}) const {
    return Chain(GetParam().kind, GetParam().coupled, start);
  }
  /// Apart there is no force, and a pose felt before feels the same again.
  void expect_recovery(Chain& worn) const {
    for (int i = 0; i < 300; ++i) worn.tick({kFar_m, {}});
    EXPECT_EQ(worn.stage.state(), LoopState::rendering);
    EXPECT_TRUE(worn.result.contacts.empty());
    EXPECT_LT(norm(worn.sent.force_N), 1e-6);
    Chain fresh = chain();
    const Pose touching{{0, 0, -0.0222}, {}};
    for (int i = 0; i < 300; ++i) {
      worn.tick(touching);
      fresh.tick(touching);
    }
    EXPECT_NEAR(norm(worn.sent.force_N - fresh.sent.force_N), 0, 1e-3 * kMaxForce_N);
  }
};

TEST_P(HostileMotion, teleports) {
  Chain c = chain();
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(-0.06, 0.06);
  for (int i = 0; i < effort(3000, 300); ++i) {
    c.tick({{u(rng), u(rng), u(rng)}, turn(3.0 * random_unit(rng))});
  }
  expect_recovery(c);
}

TEST_P(HostileMotion, spin_of_50_rad_per_s) {
  Chain c = chain();
  for (int i = 0; i < effort(1500, 300); ++i) {
    c.tick({{0.01, 0, -0.0215}, turn({0.05 * i, 0, 0.02 * i})});
  }
  expect_recovery(c);
}

TEST_P(HostileMotion, ten_metres_a_second_through_a_thin_wall_and_back) {
  Chain c = chain();
  for (int i = 0; i < effort(800, 200); ++i) {
    const double phase = std::fmod(0.01 * i, 0.4);  // 10 m/s to and fro over 0.2 m
    c.tick({{0.001, 0, (phase < 0.2 ? phase : 0.4 - phase) - 0.1}, {}});
  }
  expect_recovery(c);
}

TEST_P(HostileMotion, start_deep_inside) {
  Chain c = chain({{0, 0, -0.002}, {}});
  for (int i = 0; i < 500; ++i) c.tick({{0, 0, -0.002}, {}});
  expect_recovery(c);
}

TEST_P(HostileMotion, pushed_slowly_through_a_thin_wall) {
  Chain c = chain();
  for (int i = 0; i < 1000; ++i) c.tick({{0.0, 0.0, -0.03 + 6e-5 * i}, {}});
  expect_recovery(c);
}

INSTANTIATE_TEST_SUITE_P(Engines, HostileMotion,
                         testing::Values(Case{EngineKind::levels, false},
                                         Case{EngineKind::levels, true},
                                         Case{EngineKind::regions, false},
                                         Case{EngineKind::regions, true}),
                         [](const auto& tested) {
                           const bool levels = tested.param.kind == EngineKind::levels;
                           return std::string(levels ? "levels" : "regions") +
                                  (tested.param.coupled ? "_virtual" : "_direct");
                         });

}  // namespace
}  // namespace palpate::test

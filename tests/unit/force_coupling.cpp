// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/coupling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::force {
namespace {

constexpr double kPeriod_s = 0.001;

TEST(Matrix6, solves_what_it_multiplies) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int round = 0; round < 100; ++round) {
    Matrix6 m;
    m.add_diagonal(0.01, 0.02);
    for (int i = 0; i < 8; ++i) m.add_square({u(rng), u(rng), u(rng), u(rng), u(rng), u(rng)}, 3);
    const Vec6 x{u(rng), u(rng), u(rng), u(rng), u(rng), u(rng)};
    const Vec6 back = m.solve(m * x);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(back[i], x[i], 1e-10);
  }
}

TEST(Matrix6, that_is_not_definite_gives_numbers_all_the_same) {
  const Vec6 x = Matrix6{}.solve({1, 2, 3, 4, 5, 6});
  for (const double v : x) EXPECT_EQ(v, 0);
}

/// A half-space below z = 0 of a stiffness, touched at the tool's origin.
struct Wall {
  double k_N_per_m;
  [[nodiscard]] double depth_m(const Pose& p) const {
    return p.position_m.z < 0 ? -p.position_m.z : 0;
  }
  [[nodiscard]] Wrench wrench(const Pose& p) const { return {{0, 0, k_N_per_m * depth_m(p)}, {}}; }
  [[nodiscard]] Matrix6 stiffness(const Pose& p) const {
    Matrix6 m;
    if (depth_m(p) > 0) m.add_square({0, 0, 1, 0, 0, 0}, k_N_per_m);
    return m;
  }
};

TEST(VirtualTool, at_the_handle_and_at_rest_pushes_nothing) {
  VirtualTool tool({});
  const Pose at{{1, 2, 3}, {0.5, 0.5, 0.5, 0.5}};
  tool.reset(at);
  const Wrench w = tool.step(at, {}, {}, kPeriod_s);
  EXPECT_LT(norm(w.force_N) + norm(w.torque_Nm), 1e-12);
}

TEST(VirtualTool, follows_the_handle_in_the_open) {
  VirtualTool tool({});
  tool.reset({});
  const Pose there{{0.01, -0.02, 0.03}, {std::cos(0.2), std::sin(0.2), 0, 0}};
  Wrench w;
  for (int i = 0; i < 2000; ++i) w = tool.step(there, {}, {}, kPeriod_s);
  EXPECT_LT(norm(tool.pose().position_m - there.position_m), 1e-9);
  EXPECT_NEAR(tool.pose().orientation.x, there.orientation.x, 1e-9);
  EXPECT_LT(norm(w.force_N) + norm(w.torque_Nm), 1e-6);
}

TEST(VirtualTool, pressed_on_a_wall_is_two_springs_in_series) {
  for (const double k : {100.0, 1000.0, 1e6, 1e9}) {
    const Wall wall{k};
    VirtualTool tool({});
    tool.reset({});
    const Pose handle{{0, 0, -0.002}, {}};
    Wrench w;
    for (int i = 0; i < 4000; ++i)
      w = tool.step(handle, wall.wrench(tool.pose()), wall.stiffness(tool.pose()), kPeriod_s);
    const double expected_N = 0.002 * k * 1000 / (k + 1000);
    EXPECT_NEAR(w.force_N.z, expected_N, 1e-4 * expected_N) << k;
  }
}

TEST(VirtualTool, pushes_and_turns_towards_itself) {
  VirtualTool tool({});
  tool.reset({});
  const Wrench w = tool.step({{0.001, 0, 0}, {std::cos(0.01), 0, std::sin(0.01), 0}}, {}, {}, 1e-6);
  EXPECT_LT(w.force_N.x, -0.9);
  EXPECT_LT(w.torque_Nm.y, 0);
}

/// A handle thrown about against walls of any stiffness: never more than the spring and damper can
/// give for where it is, and everything stays finite.
TEST(VirtualTool, stays_finite_against_any_stiffness_and_teleports) {
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> u(-1, 1);
  for (const double k : {0.0, 1e3, 1e6, 1e12}) {
    const Wall wall{k};
    VirtualTool tool({});
    tool.reset({});
    for (int i = 0; i < 5000; ++i) {
      const double angle = u(rng);
      const Pose handle{{u(rng), u(rng), u(rng)}, {std::cos(angle), 0, 0, std::sin(angle)}};
      const Wrench w =
          tool.step(handle, wall.wrench(tool.pose()), wall.stiffness(tool.pose()), kPeriod_s);
      ASSERT_TRUE(std::isfinite(norm(w.force_N)) && std::isfinite(norm(w.torque_Nm))) << k;
      ASSERT_LT(norm(tool.pose().position_m), 20);
    }
  }
}

}  // namespace
}  // namespace palpate::force

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/linear_contact.hpp"

#include <gtest/gtest.h>

#include "rt_core/force/coupling.hpp"

namespace palpate::force {
namespace {

constexpr double kStiffness_N_per_m = 800;

/// A spring against the tool's point r.
LinearContact spring_at(Vec3d r, double depth_m) {
  LinearContact c;
  c.wrench.force_N = {0, 0, kStiffness_N_per_m * depth_m};
  c.wrench.torque_Nm = cross(r, c.wrench.force_N);
  c.stiffness.add_square(vec6({0, 0, 1}, cross(r, Vec3d{0, 0, 1})), kStiffness_N_per_m);
  return c;
}

TEST(LinearContact, foretells_the_spring_it_is_made_of) {
  const LinearContact c = spring_at({0.02, 0, 0}, 0.001);
  const Wrench deeper = predicted(c, {{0.5, 0, -0.0002}, {}});
  EXPECT_NEAR(deeper.force_N.z, kStiffness_N_per_m * 0.0012, 1e-12);
  EXPECT_NEAR(deeper.torque_Nm.y, -0.02 * kStiffness_N_per_m * 0.0012, 1e-12);
  const Wrench turned = predicted(c, {{}, {1, 0, 0.5e-4, 0}});  // by 1e-4 about y: r sinks by 2e-6
  EXPECT_NEAR(turned.force_N.z, kStiffness_N_per_m * (0.001 + 2e-6), 1e-9);
}

TEST(LinearContact, where_it_was_asked_is_the_wrench_itself) {
  LinearContact c = spring_at({0.02, -0.01, 0.3}, 0.001);
  c.tool = {{1, 2, 3}, {0.5, 0.5, -0.5, 0.5}};
  EXPECT_EQ(predicted(c, c.tool).force_N, c.wrench.force_N);
  EXPECT_EQ(predicted(c, c.tool).torque_Nm, c.wrench.torque_Nm);
}

TEST(Damping, resists_velocity_into_the_contact_and_out_of_it) {
  const LinearContact c = spring_at({}, 0.001);  // 0.8 N
  const double damping_s = 2 / kStiffness_N_per_m;
  for (const double v : {-0.1, 0.1}) {
    const Wrench w = damped(c.wrench, c.stiffness, vec6({0.3, 0, v}, {}), damping_s);
    EXPECT_NEAR(w.force_N.z, 0.8 - 2 * v, 1e-12);
    EXPECT_EQ(w.force_N.x, 0);
  }
}

TEST(Damping, never_pulls_and_never_more_than_doubles) {
  const LinearContact c = spring_at({}, 0.0001);  // 0.08 N
  const double damping_s = 2 / kStiffness_N_per_m;
  EXPECT_NEAR(damped(c.wrench, c.stiffness, vec6({0, 0, 1}, {}), damping_s).force_N.z, 0, 1e-15);
  EXPECT_NEAR(damped(c.wrench, c.stiffness, vec6({0, 0, -1}, {}), damping_s).force_N.z, 0.16,
              1e-15);
  const LinearContact begun = spring_at({}, 0);
  EXPECT_EQ(damped(begun.wrench, begun.stiffness, vec6({0, 0, -1}, {}), damping_s).force_N.z, 0);
}

TEST(Damping, of_the_simulated_tool_is_implicit) {
  CouplingSettings s;
  s.contact_damping_s = 0.002;
  constexpr double kPeriod_s = 0.001;
  VirtualTool tool(s);
  tool.reset({});
  const LinearContact c = spring_at({}, 0.001);
  static_cast<void>(tool.step({}, c.wrench, c.stiffness, kPeriod_s));
  const double t = kPeriod_s, k = kStiffness_N_per_m;
  const double damper = 2 * sqrt_of(s.spring_N_per_m * s.mass_kg);
  const double heavy = s.mass_kg + t * damper + t * t * (s.spring_N_per_m + k) + t * 0.002 * k;
  EXPECT_NEAR(tool.pose().position_m.z, t * t * c.wrench.force_N.z / heavy, 1e-15);
}

}  // namespace
}  // namespace palpate::force

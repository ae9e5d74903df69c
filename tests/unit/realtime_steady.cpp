// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/steady_query.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/virtual_loop.hpp"

namespace palpate::realtime {
namespace {

using test::QueryOf;
using test::wall;

constexpr double kPeriod_s = 1e-3;

Pose at_z(double z_m) {
  Pose pose;
  pose.position_m.z = z_m;
  return pose;
}

double force_N(SteadyQuery& query, const Pose& pose) {
  TickResult out;
  EXPECT_EQ(query.tick(pose, {}, out), Status::ok);
  return out.wrench.force_N.z;
}

TEST(SteadyQuery, leaves_a_force_alone_that_follows_its_model) {
  QueryOf contacts(wall(600));
  SteadyQuery query(contacts, {10, 1}, kPeriod_s);
  for (int i = 0; i < 400; ++i) static_cast<void>(force_N(query, at_z(-0.001)));
  // 6 N/s of the rate's 10 would be too slow for this, at 1 m/s.
  EXPECT_NEAR(force_N(query, at_z(-0.002)), 1.2, 1e-12);
  EXPECT_NEAR(force_N(query, at_z(-0.0005)), 0.3, 1e-12);
  EXPECT_EQ(norm(query.off().force_N), 0);
}

TEST(SteadyQuery, brings_a_jump_at_its_rate) {
  double stiffness = 600;
  QueryOf contacts(
      [&](const Pose& p, const Budget& b, TickResult& out) { return wall(stiffness)(p, b, out); });
  SteadyQuery query(contacts, {50, 1}, kPeriod_s);
  for (int i = 0; i < 100; ++i) static_cast<void>(force_N(query, at_z(-0.001)));
  stiffness = 900;  // 0.3 N more without a motion
  for (int i = 1; i <= 6; ++i) {
    EXPECT_NEAR(force_N(query, at_z(-0.001)), 0.6 + 0.05 * i, 1e-12);
    EXPECT_NEAR(query.off().force_N.z, -0.3 + 0.05 * i, 1e-12);
  }
  EXPECT_NEAR(force_N(query, at_z(-0.001)), 0.9, 1e-12);
}

TEST(SteadyQuery, forgets_a_contact_that_is_gone_at_its_rate) {
  QueryOf contacts(wall(600));
  SteadyQuery query(contacts, {100, 1}, kPeriod_s);
  for (int i = 0; i < 50; ++i) static_cast<void>(force_N(query, at_z(-0.001)));
  // Its model, a spring, pulls beyond the wall; contacts of the new place have none.
  EXPECT_NEAR(force_N(query, at_z(0.0005)), -0.2, 1e-12);
  EXPECT_NEAR(force_N(query, at_z(0.0005)), -0.1, 1e-12);
  EXPECT_NEAR(force_N(query, at_z(0.0005)), 0, 1e-12);
}

TEST(SteadyQuery, widens_the_certificate_by_what_it_holds_back) {
  QueryOf contacts(wall(600));
  SteadyQuery query(contacts, {100, 1}, kPeriod_s);
  TickResult out;
  ASSERT_EQ(query.tick(at_z(-0.001), {}, out), Status::ok);
  EXPECT_NEAR(out.wrench.force_N.z, 0.1, 1e-12);
  EXPECT_NEAR(out.certificate.force_bound_N, 0.5, 1e-12);
}

TEST(SteadyQuery, of_infinite_rates_is_not_there) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  QueryOf contacts(wall(600));
  SteadyQuery query(contacts, {kInfinity, kInfinity}, kPeriod_s);
  EXPECT_EQ(force_N(query, at_z(-0.001)), 0.6);
  EXPECT_EQ(force_N(query, at_z(0.001)), 0);
}

TEST(SteadyQuery, hands_an_error_on) {
  QueryOf contacts([](const Pose&, const Budget&, TickResult&) { return Status::bad_pose; });
  SteadyQuery query(contacts, {}, kPeriod_s);
  TickResult out;
  EXPECT_EQ(query.tick({}, {}, out), Status::bad_pose);
}

}  // namespace
}  // namespace palpate::realtime

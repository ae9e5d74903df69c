// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/steady_query.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/poses.hpp"
#include "tests/support/virtual_loop.hpp"

namespace palpate::realtime {
namespace {

using palpate::test::at_z;
using test::QueryOf;
using test::wall;

constexpr double kSteadyPeriod_s = 1e-3;
constexpr double kWall_N_per_m = 600;

double force_N(SteadyQuery& query, const Pose& pose) {
  TickResult out;
  EXPECT_EQ(query.tick(pose, {}, out), Status::ok);
  return out.wrench.force_N.z;
}

TEST(SteadyQuery, leaves_a_force_alone_that_follows_its_model) {
  QueryOf contacts(wall(kWall_N_per_m));
  SteadyQuery query(contacts, {10, 1}, kWall_N_per_m, kSteadyPeriod_s);
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
  SteadyQuery query(contacts, {50, 1}, kWall_N_per_m, kSteadyPeriod_s);
  for (int i = 0; i < 100; ++i) static_cast<void>(force_N(query, at_z(-0.001)));
  stiffness = 900;  // 0.3 N more without a motion
  for (int i = 1; i <= 6; ++i) {
    EXPECT_NEAR(force_N(query, at_z(-0.001)), 0.6 + 0.05 * i, 1e-12);
    EXPECT_NEAR(query.off().force_N.z, -0.3 + 0.05 * i, 1e-12);
  }
  EXPECT_NEAR(force_N(query, at_z(-0.001)), 0.9, 1e-12);
}

TEST(SteadyQuery, forgets_a_contact_that_is_gone_at_its_rate) {
  QueryOf contacts(wall(kWall_N_per_m));
  SteadyQuery query(contacts, {100, 1}, kWall_N_per_m, kSteadyPeriod_s);
  for (int i = 0; i < 50; ++i) static_cast<void>(force_N(query, at_z(-0.001)));
  // Its model, a spring, pulls beyond the wall; contacts of the new place have none.
  EXPECT_NEAR(force_N(query, at_z(0.0005)), -0.2, 1e-12);
  EXPECT_NEAR(force_N(query, at_z(0.0005)), -0.1, 1e-12);
  EXPECT_NEAR(force_N(query, at_z(0.0005)), 0, 1e-12);
}

TEST(SteadyQuery, widens_the_certificate_by_what_it_holds_back) {
  QueryOf contacts(wall(kWall_N_per_m));
  SteadyQuery query(contacts, {100, 1}, kWall_N_per_m, kSteadyPeriod_s);
  TickResult out;
  ASSERT_EQ(query.tick(at_z(-0.001), {}, out), Status::ok);
  EXPECT_NEAR(out.wrench.force_N.z, 0.1, 1e-12);
  EXPECT_NEAR(out.certificate.force_bound_N, 0.5, 1e-12);
}

/// A wall whose distance may be off, with some force beside its own.
struct UncertainWall {
  double error_m = 0;
  double more_N = 0;
  bool gone = false;
  bool ended_deep = false;  ///< by the budget, while overlapping
  QueryOf contacts{[this](const Pose& pose, const Budget& budget, TickResult& out) {
    const Status status = wall(kWall_N_per_m)(pose, budget, out);
    out.wrench.force_N.z += more_N;
    if (gone) out = {};
    out.certificate.error_bound_m = error_m;
    out.certificate.truncated_by_units = ended_deep;
    if (ended_deep) out.min_distance_m = -1e-4;
    return status;
  }};
  SteadyQuery query{contacts, {}, kWall_N_per_m, kSteadyPeriod_s};
};

/// Along the wall at 0.1 m/s, a millimetre deep.
Pose slid(int tick) {
  Pose pose = at_z(-0.001);
  pose.position_m.x = 1e-4 * tick;
  return pose;
}
constexpr double kDoubtful_m = 0.001;
/// What is let in of a force that does not change as it slides: 2 N/s, and little for one change.
constexpr double kSmooth_N = 0.0025;

TEST(SteadyQuery, believes_what_is_certain_at_once) {
  UncertainWall wall;
  for (int i = 0; i < 100; ++i) static_cast<void>(force_N(wall.query, slid(i)));
  wall.more_N = 0.1;
  EXPECT_NEAR(force_N(wall.query, slid(100)), 0.7, 1e-12);
  // 0.1 N within 0.02 mm at both ends: 0.036 N of it are doubtful.
  wall.error_m = 2e-5;
  static_cast<void>(force_N(wall.query, slid(101)));
  wall.more_N = 0.2;
  const double after_N = force_N(wall.query, slid(102));
  EXPECT_GT(after_N, 0.7 + 0.064 - 1e-9);
  EXPECT_LT(after_N, 0.8 - 0.03);
}

TEST(SteadyQuery, is_certain_of_less_than_the_motion_makes_where_a_budget_ended_an_overlap) {
  UncertainWall wall;
  for (int i = 0; i < 100; ++i) static_cast<void>(force_N(wall.query, slid(i)));
  wall.ended_deep = true;
  wall.more_N = 0.1;
  double before_N = 0.6;
  constexpr double kOfMotion_N = kWall_N_per_m * 1e-4;
  for (int i = 100; before_N < 0.7 - 1e-12 && i < 200; ++i) {
    const double now_N = force_N(wall.query, slid(i));
    EXPECT_LE(now_N - before_N, 0.6 * kOfMotion_N + 2 * kSmooth_N);
    EXPECT_GT(now_N, before_N);
    before_N = now_N;
  }
  EXPECT_NEAR(before_N, 0.7, 1e-12);
}

TEST(SteadyQuery, lets_what_may_not_be_true_in_no_faster_than_the_force_usually_changes) {
  UncertainWall wall;
  wall.error_m = kDoubtful_m;
  double before_N = 0;
  for (int i = 0; i < 100; ++i) before_N = force_N(wall.query, slid(i));
  EXPECT_NEAR(before_N, 0.6, 1e-12);
  wall.more_N = 0.1;
  for (int i = 100; i < 160; ++i) {
    const double now_N = force_N(wall.query, slid(i));
    EXPECT_LE(now_N - before_N, kSmooth_N);
    before_N = now_N;
  }
  EXPECT_NEAR(before_N, 0.7, 1e-12);
}

TEST(SteadyQuery, lets_it_in_at_once_where_the_force_changes_as_much_all_the_time) {
  UncertainWall wall;
  wall.error_m = kDoubtful_m;
  double sent_N = 0;
  for (int i = 0; i < 200; ++i) {
    wall.more_N = i % 2 == 0 ? 0 : 0.05;
    sent_N = force_N(wall.query, slid(i));
  }
  EXPECT_NEAR(sent_N, 0.65, 1e-12);
}

TEST(SteadyQuery, brings_what_was_doubtful_in_no_faster_once_it_is_certain) {
  UncertainWall wall;
  wall.error_m = kDoubtful_m;
  for (int i = 0; i < 100; ++i) static_cast<void>(force_N(wall.query, slid(i)));
  wall.more_N = 0.1;
  double before_N = force_N(wall.query, slid(100));
  wall.error_m = 0;
  for (int i = 101; i < 160; ++i) {
    const double now_N = force_N(wall.query, slid(i));
    EXPECT_LE(now_N - before_N, kSmooth_N);
    before_N = now_N;
  }
  EXPECT_NEAR(before_N, 0.7, 1e-12);
}

TEST(SteadyQuery, lets_go_at_its_rate_where_certainly_nothing_touches) {
  UncertainWall wall;
  for (int i = 0; i < 100; ++i) static_cast<void>(force_N(wall.query, slid(i)));
  wall.gone = true;
  wall.error_m = kDoubtful_m;
  EXPECT_GT(force_N(wall.query, slid(100)), 0.59);
  EXPECT_GT(force_N(wall.query, slid(101)), 0.58);
  wall.error_m = 0;
  static_cast<void>(force_N(wall.query, slid(102)));
  for (int i = 103; i < 107; ++i) static_cast<void>(force_N(wall.query, slid(i)));
  EXPECT_EQ(force_N(wall.query, slid(107)), 0);
}

TEST(SteadyQuery, follows_the_way_into_a_doubtful_surface) {
  UncertainWall wall;
  wall.error_m = kDoubtful_m;
  for (int i = 0; i < 100; ++i) static_cast<void>(force_N(wall.query, at_z(-0.001)));
  double before_N = 0.6;
  for (int i = 1; i <= 20; ++i) {
    const double now_N = force_N(wall.query, at_z(-0.001 - 1e-4 * i));
    EXPECT_GE(now_N - before_N, 0.6 * 0.06 - 1e-12);
    before_N = now_N;
  }
}

TEST(UsualShare, is_the_mean_of_late) {
  UsualShare usual;
  for (int i = 0; i < 400; ++i) usual.note(i % 2 == 0 ? 0.4 : 0.8);
  EXPECT_NEAR(usual.now(), 0.6, 0.01);
  for (int i = 0; i < 400; ++i) usual.note(0.02);
  EXPECT_NEAR(usual.now(), 0.02, 0.002);
}

TEST(UsualShare, does_not_rise_much_for_a_single_change) {
  UsualShare usual;
  for (int i = 0; i < 400; ++i) usual.note(0.02);
  usual.note(100);
  EXPECT_LT(usual.now(), 0.023);
}

TEST(SteadyQuery, of_infinite_rates_is_not_there) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  QueryOf contacts(wall(kWall_N_per_m));
  SteadyQuery query(contacts, {kInfinity, kInfinity}, kWall_N_per_m, kSteadyPeriod_s);
  EXPECT_EQ(force_N(query, at_z(-0.001)), 0.6);
  EXPECT_EQ(force_N(query, at_z(0.001)), 0);
}

TEST(SteadyQuery, hands_an_error_on) {
  QueryOf contacts([](const Pose&, const Budget&, TickResult&) { return Status::bad_pose; });
  SteadyQuery query(contacts, {}, kWall_N_per_m, kSteadyPeriod_s);
  TickResult out;
  EXPECT_EQ(query.tick({}, {}, out), Status::bad_pose);
}

}  // namespace
}  // namespace palpate::realtime

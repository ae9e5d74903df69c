// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts at 1 kHz, force at 4 and 10 kHz: in virtual time, and on two threads.
#include "tools/realtime/contact_server.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tests/support/virtual_loop.hpp"
#include "tools/realtime/coupled_query.hpp"
#include "tools/realtime/damped_query.hpp"
#include "tools/realtime/friction_query.hpp"

namespace palpate::realtime {
namespace {

using test::QueryOf;
using test::VirtualLoop;
using test::wall;

Pose at(double x_m, double z_m) {
  Pose pose;
  pose.position_m = {x_m, 0, z_m};
  return pose;
}

hal::mock::HandParameters hand_on_wall() {
  hal::mock::HandParameters hand;
  hand.damping_N_s_per_m = 2;
  hand.script = {
      {0, at(0, 0.004)}, {0.4, at(0, 0.004)}, {0.5, at(0, -0.002)}, {1000, at(0, -0.002)}};
  return hand;
}

LoopSettings lasting(std::uint64_t periods) {
  LoopSettings settings;
  settings.periods = periods;
  return settings;
}

/// A query that asks `slow` every so many ticks and holds its answer, which is what a loop without
/// a model does.
QueryOf::Function held(QueryOf::Function slow, int every) {
  return [slow = std::move(slow), every, tick = 0, last = TickResult{}](
             const Pose& tool, const Budget& budget, TickResult& out) mutable {
    if (tick++ % every == 0) static_cast<void>(slow(tool, budget, last));
    out = last;
    return Status::ok;
  };
}

struct Served {
  Served(QueryOf::Function scene, int every, std::uint32_t most_ticks)
      : contacts(std::move(scene)), server(contacts), modelled(server, most_ticks), every_(every) {}

  /// What a loop asks; the server answers every so many ticks, the pose of the tick before.
  QueryOf::Function function(ContactQuery& top) {
    return [this, &top, tick = 0](const Pose& tool, const Budget& budget, TickResult& out) mutable {
      if (tick++ % every_ == 0) server.serve({});
      return top.tick(tool, budget, out);
    };
  }

  QueryOf contacts;
  ContactServer server;
  ModelledQuery modelled;

 private:
  int every_;
};

struct Outcome {
  LoopReport report;
  double swing_m = 0;
  double rest_m = 0;
};

Outcome pressed(const QueryOf::Function& scene, double rate_Hz) {
  LoopSettings settings;
  settings.rate_Hz = rate_Hz;
  settings.periods = static_cast<std::uint64_t>(8 * rate_Hz);
  hal::mock::HandParameters hand = hand_on_wall();
  VirtualLoop rig(hand, settings, scene, 1u << 17, VirtualLoop::virtual_time(2 * rate_Hz));
  Outcome out{rig.run()};
  const auto records = rig.records();
  double low_m = 1, high_m = -1;
  for (std::size_t i = records.size() * 15 / 16; i < records.size(); ++i) {
    low_m = std::min(low_m, records[i].position_m[2]);
    high_m = std::max(high_m, records[i].position_m[2]);
  }
  out.swing_m = high_m - low_m;
  out.rest_m = 0.5 * (high_m + low_m);
  return out;
}

TEST(ContactServer, at_a_quarter_and_a_tenth_of_the_rate_serves_a_wall_that_its_own_rate_cannot) {
  // At 1 kHz a hand of 2 N s/m takes 2000 N/m at most; here are 5000.
  constexpr double kStiffness_N_per_m = 5000;
  for (const int every : {4, 10}) {
    const double rate_Hz = 1000.0 * every;
    Served served(wall(kStiffness_N_per_m), every, 100);
    const Outcome modelled = pressed(served.function(served.modelled), rate_Hz);
    const Outcome zero_order = pressed(held(wall(kStiffness_N_per_m), every), rate_Hz);
    EXPECT_LT(modelled.swing_m, 1e-6) << every;
    EXPECT_GT(zero_order.swing_m, 1e-5) << every;
    EXPECT_NEAR(modelled.rest_m, -0.002 * 300 / (300 + kStiffness_N_per_m), 1e-6);
    EXPECT_EQ(modelled.report.state, LoopState::rendering);
  }
}

TEST(ContactServer, serves_a_simulated_tool_too) {
  Served served(wall(1e6), 4, 100);
  force::CouplingSettings settings;
  settings.spring_N_per_m = 2000;
  CoupledQuery coupled(served.modelled, settings, 1 / 4000.0);
  const Outcome felt = pressed(served.function(coupled), 4000);
  EXPECT_LT(felt.swing_m, 1e-6);
  const double both_N_per_m = 1 / (1 / 2000.0 + 1 / 1e6);
  EXPECT_NEAR(felt.rest_m, -0.002 * 300 / (300 + both_N_per_m), 1e-6);
}

TEST(ContactServer, that_stops_is_a_fault) {
  Served served(wall(600), 4, 100);
  int ticks = 0;
  const QueryOf::Function alive = served.function(served.modelled);
  const auto scene = [&](const Pose& tool, const Budget& budget, TickResult& out) {
    return ++ticks < 6000 ? alive(tool, budget, out) : served.modelled.tick(tool, budget, out);
  };
  const Outcome felt = pressed(scene, 4000);
  EXPECT_EQ(felt.report.state, LoopState::fault);
  EXPECT_TRUE(felt.report.faults.has(Fault::engine_error));
}

TEST(ContactServer, error_of_the_contacts_is_the_answer) {
  QueryOf refusing([](const Pose&, const Budget&, TickResult&) { return Status::bad_pose; });
  ContactServer server(refusing);
  ModelledQuery modelled(server, 10);
  TickResult out;
  EXPECT_EQ(modelled.tick({}, {}, out), Status::ok);  // nothing known yet: no force
  EXPECT_EQ(norm(out.wrench.force_N), 0);
  server.serve({});
  EXPECT_EQ(modelled.tick({}, {}, out), Status::bad_pose);
}

TEST(ContactServer, on_a_thread_of_its_own_answers_the_newest_pose) {
  QueryOf contacts(wall(600));
  ContactServer server(contacts);
  ModelledQuery modelled(server, 1u << 30);
  hal::MonotonicClock clock;
  std::atomic<bool> stop{false};
  std::thread thread([&] { server.run({}, clock, stop); });
  TickResult out;
  for (int i = 0; i < 100'000 && out.contacts.empty(); ++i) {
    ASSERT_EQ(modelled.tick(at(0, -0.001), {}, out), Status::ok);
    clock.sleep_until(clock.now_ns() + 100'000);
  }
  stop = true;
  thread.join();
  EXPECT_NEAR(out.wrench.force_N.z, 0.6, 1e-12);
}

TEST(DampedContacts, settle_a_tapping_hand_and_give_out_no_energy) {
  const auto tapped = [](double damping_s) {
    QueryOf contacts(wall(1000));
    DampedQuery query(contacts, damping_s, 1e-3);
    hal::mock::HandParameters hand = hand_on_wall();
    hand.damping_N_s_per_m = 3;
    VirtualLoop rig(hand, lasting(1000), [&](const Pose& tool, const Budget& b, TickResult& out) {
      return query.tick(tool, b, out);
    });
    return rig.run();
  };
  const LoopReport bare = tapped(0), damped = tapped(0.5 / 1000);
  EXPECT_GE(damped.energy_J_min, -5e-6);
  EXPECT_GT(damped.energy_J, bare.energy_J);
}

/// The wall with contacts of the engine's kind: 1 mm of delta outside of it.
Status rubbed(const Pose& tool, TickResult& out, std::vector<Contact>& contact) {
  constexpr double kStiffness_N_per_m = 600, kDelta_m = 0.001;
  out = {};
  const double depth_m = kDelta_m - tool.position_m.z;
  if (depth_m <= 0) return Status::ok;
  contact.resize(1);
  contact[0].point_a_m = contact[0].point_b_m = contact[0].centre_m = tool.position_m;
  contact[0].normal = {0, 0, 1};
  contact[0].distance_m = tool.position_m.z;
  contact[0].weight = 1;
  out.contacts = contact;
  out.wrench.force_N.z = kStiffness_N_per_m * depth_m;
  out.stiffness.add_square({0, 0, 1, 0, 0, 0}, kStiffness_N_per_m);
  return Status::ok;
}

TEST(FrictionInTheLoop, holds_the_hand_until_the_pull_is_too_much_and_gives_out_no_energy) {
  constexpr double kMu = 0.5;
  const BodyPair pairs[] = {{0, 1}};
  const Pose poses[2] = {};
  const double coefficients[] = {kMu};
  const Settings settings{.delta_m = 0.001, .stiffness_N_per_m = 600};
  std::vector<Contact> contact;
  QueryOf contacts(
      [&](const Pose& tool, const Budget&, TickResult& out) { return rubbed(tool, out, contact); });
  FrictionQuery query(contacts, pairs, 0, settings, poses, coefficients);
  hal::mock::HandParameters hand;
  hand.script = {{0, at(0, 0.004)},
                 {0.5, at(0, -0.004)},
                 {1.5, at(0, -0.004)},
                 {2.5, at(0.02, -0.004)},
                 {1000, at(0.02, -0.004)}};
  VirtualLoop rig(hand, lasting(5000), [&](const Pose& tool, const Budget& b, TickResult& out) {
    return query.tick(tool, b, out);
  });
  const LoopReport& r = rig.run();
  const auto records = rig.records();
  // Sliding, the hand lags its path by mu N / grip.
  const TraceRecord& sliding = records[2400];
  const double normal_N = sliding.rendered_force_N[2];
  EXPECT_NEAR(sliding.position_m[0], 0.018 - kMu * normal_N / hand.grip_N_per_m, 5e-5);
  // 0.05 s after its start the path pulls with 0.3 N and drags with 0.1 N: the contact sticks, a
  // spring beside the grip's.
  EXPECT_NEAR(records[1550].position_m[0], 0.4 / (300 + 600), 5e-5);
  EXPECT_GE(r.energy_J_min, -1e-6);
}

}  // namespace
}  // namespace palpate::realtime

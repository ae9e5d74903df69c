// SPDX-License-Identifier: GPL-3.0-or-later
// Each idea that saves pairs, switched alone: the same exact contacts, fewer queries.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "tests/support/answers.hpp"
#include "tests/support/coarse_bodies.hpp"

namespace palpate::test {
namespace {

/// Slides in contact, parts and comes back, and jumps to another side once.
Pose motion(int i) {
  const double apart = i % 40 > 30 ? 0.02 * (i % 40 - 30) : 0;
  const double side = i < 60 ? 1 : -1;
  return {{side * (1.82 + 0.03 * std::sin(0.2 * i) + apart), 0.3 * std::sin(0.03 * i), 0.004 * i},
          turn({0.01 * i, 0.004 * i, 0})};
}
constexpr int kTicks = 100;

struct Answers {
  std::vector<PieceNumbers> pairs;
  std::vector<Vec3d> forces_N;
  std::uint64_t queries = 0;
};

Answers run(const Settings& settings) {
  BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
  Answers out;
  for (int i = 0; i < kTicks; ++i) {
    const Pose poses[2] = {motion(i), {}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    out.pairs.push_back(pairs_of(r));
    out.forces_N.push_back(r.wrench.force_N);
    out.queries += r.queries;
  }
  return out;
}

Settings exact() { return {.delta_m = kDelta, .exact = true, .cluster_radius_m = 0.1}; }

TEST(EngineSettings, exact_contacts_are_the_same_with_each_idea_on_and_off) {
  const Answers base = run(exact());
  std::size_t touching = 0;
  for (const PieceNumbers& pairs : base.pairs) touching += pairs.empty() ? 0u : 1u;
  EXPECT_GT(touching, std::size_t{kTicks} / 3);
  EXPECT_LT(touching, static_cast<std::size_t>(kTicks));
  for (unsigned off = 1; off < 16; ++off) {
    Settings settings = exact();
    settings.front_tracking = (off & 1) == 0;
    settings.motion_bounds = (off & 2) == 0;
    settings.root_short_cut = (off & 4) == 0;
    settings.bounds = (off & 8) == 0 ? Bounds::tight : Bounds::paper;
    const Answers other = run(settings);
    for (std::size_t i = 0; i < base.pairs.size(); ++i) {
      ASSERT_EQ(base.pairs[i], other.pairs[i]) << "tick " << i << ", settings " << off;
      ASSERT_NEAR(norm(base.forces_N[i] - other.forces_N[i]), 0,
                  1e-5 * (1 + norm(base.forces_N[i])));
    }
  }
}

TEST(EngineSettings, each_idea_saves_queries) {
  const std::uint64_t all = run(exact()).queries;
  Settings settings = exact();
  settings.front_tracking = false;
  EXPECT_GT(run(settings).queries, all);
  settings = exact();
  settings.motion_bounds = false;
  EXPECT_GT(run(settings).queries, all);
  settings = exact();
  settings.bounds = Bounds::paper;
  EXPECT_GT(run(settings).queries, all);
}

// Spheres overlap, hulls do not.
TEST(EngineSettings, root_short_cut_makes_parted_hulls_cost_one_query) {
  const BakedBody flat(box(1, 1, 0.02));
  const BakedBody bumpy(bumpy_ball(12, 16, 0.3));
  BakedScene scene({bumpy.view, flat.view}, {{0, 1}}, exact());
  const Pose near[2] = {{{0, 0, 0.36}, {}}, {}};
  EXPECT_GT(tick_or_fail(*scene.engine, near).front_nodes, 1u);
  const Pose parted[2] = {{{0, 0, 0.44}, {}}, {}};
  const TickResult r = tick_or_fail(*scene.engine, parted);
  EXPECT_EQ(r.front_nodes, 1u);
  EXPECT_LE(r.queries, 1u);
  EXPECT_TRUE(r.contacts.empty());
  EXPECT_LT(r.certificate.error_bound_m, 1e-5);
}

}  // namespace
}  // namespace palpate::test

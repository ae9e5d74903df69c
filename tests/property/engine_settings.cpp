// SPDX-License-Identifier: GPL-3.0-or-later
// What saves queries: the same exact contacts, fewer of them measured.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

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

/// Of a tick; `cold`: of an engine made for it.
class Motion {
 public:
  Motion(const Settings& settings, bool cold) : settings_(settings), cold_(cold) {}

  TickResult tick(int i) {
    if (cold_ || !scene_) {
      scene_ =
          std::make_unique<BakedScene>(std::vector<ImageView>{bodies().a.view, bodies().b.view},
                                       std::vector<BodyPair>{{0, 1}}, settings_);
    }
    const Pose poses[2] = {motion(i), {}};
    return tick_or_fail(*scene_->engine, poses);
  }

 private:
  Settings settings_;
  bool cold_;
  std::unique_ptr<BakedScene> scene_;
};

Settings exact(Bounds bounds = Bounds::tight) {
  return {.delta_m = kDelta, .exact = true, .bounds = bounds, .cluster_radius_m = 0.1};
}

std::uint64_t queries(const Settings& settings, bool cold) {
  Motion motion(settings, cold);
  std::uint64_t sum = 0;
  for (int i = 0; i < kTicks; ++i) sum += motion.tick(i).queries;
  return sum;
}

TEST(EngineSettings, exact_contacts_are_those_of_a_cold_start_with_either_bounds) {
  Motion cold(exact(), true);
  Motion tight(exact(), false);
  Motion paper(exact(Bounds::paper), false);
  int touching = 0;
  for (int i = 0; i < kTicks; ++i) {
    const TickResult base = cold.tick(i);
    const PieceNumbers pairs = pairs_of(base);
    touching += pairs.empty() ? 0 : 1;
    for (Motion* other : {&tight, &paper}) {
      const TickResult r = other->tick(i);
      ASSERT_EQ(pairs, pairs_of(r)) << "tick " << i;
      ASSERT_NEAR(norm(base.wrench.force_N - r.wrench.force_N), 0,
                  1e-5 * (1 + norm(base.wrench.force_N)));
    }
  }
  EXPECT_GT(touching, kTicks / 3);
  EXPECT_LT(touching, kTicks);
}

TEST(EngineSettings, last_tick_and_tight_bounds_save_queries) {
  const std::uint64_t warm = queries(exact(), false);
  EXPECT_GT(queries(exact(), true), warm);
  EXPECT_GT(queries(exact(Bounds::paper), false), warm);
}

// Spheres overlap, hulls do not.
TEST(EngineSettings, parted_hulls_cost_one_query) {
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

// SPDX-License-Identifier: GPL-3.0-or-later
// Exact wrenches of both engines are those of docs/CONTACT.md, by an oracle that tries everything.
#include "tests/support/contact_oracle.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/baked_scene.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

constexpr double kStiffness = 600;

struct Shapes {
  const char* name;
  bake::Mesh (*tool)();
  bake::Mesh (*base)();
};

void PrintTo(const Shapes& shapes, std::ostream* os) { *os << shapes.name; }

class ContactOracle : public testing::TestWithParam<Shapes> {};

TEST_P(ContactOracle, tells_the_wrench_that_both_engines_find) {
  const BakedBody tool(GetParam().tool(), bake::ForEngine::both);
  const BakedBody base(GetParam().base(), bake::ForEngine::both);
  const OracleSurface tool_surface(tool.view), base_surface(base.view);
  constexpr double kDelta = 0.05;
  Settings settings{
      .delta_m = kDelta, .exact = true, .stiffness_N_per_m = kStiffness, .cluster_radius_m = 0};
  BakedScene levels({tool.view, base.view}, {{0, 1}}, settings);
  settings.engine = EngineKind::regions;
  BakedScene regions({tool.view, base.view}, {{0, 1}}, settings);
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> gap(-2, 1);
  int felt = 0;
  for (int i = 0; i < effort(40, 8); ++i) {
    const Vec3d out = random_unit(rng);
    Pose pose = approach(tool.mesh, base.mesh, 0.1 * kDelta, 4, out, turn(3.0 * random_unit(rng)));
    pose.position_m += (gap(rng) * kDelta) * out;
    const Pose poses[2] = {pose, {}};
    const Wrench truth = contact_oracle(tool_surface, pose, base_surface, {}, kDelta, kStiffness);
    felt += norm(truth.force_N) > 0 ? 1 : 0;
    for (BakedScene* scene : {&levels, &regions}) {
      const TickResult r = tick_or_fail(*scene->engine, poses);
      EXPECT_FALSE(r.certificate.truncated()) << i;
      const double room_N = 1e-6 * (kStiffness * kDelta + norm(truth.force_N));
      EXPECT_LT(norm(r.wrench.force_N - truth.force_N), room_N) << i;
      EXPECT_LT(norm(r.wrench.torque_Nm - truth.torque_Nm), 10 * room_N) << i;
    }
  }
  EXPECT_GT(felt, effort(20, 4));
}

INSTANTIATE_TEST_SUITE_P(Shapes, ContactOracle,
                         testing::Values(Shapes{"bumpy_balls", [] { return bumpy_ball(10, 14, 1); },
                                                [] { return bumpy_ball(12, 12, 0.8); }},
                                         Shapes{"ball_on_ring", [] { return ball(8, 12, 0.5); },
                                                [] { return ring(20, 10, 1, 0.3); }},
                                         Shapes{"boxes", [] { return box(0.5, 0.3, 0.2); },
                                                [] { return box(1, 1, 0.1); }},
                                         Shapes{"quartered_boxes",
                                                [] { return quartered(box(0.5, 0.3, 0.2), 2); },
                                                [] { return quartered(box(1, 1, 0.1), 3); }},
                                         Shapes{"open_bowl", [] { return ball(6, 8, 0.3); },
                                                [] { return bowl(6, 12, 1); }}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace palpate::test

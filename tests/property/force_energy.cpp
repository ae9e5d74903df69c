// SPDX-License-Identifier: GPL-3.0-or-later
// A hand led at random through the jaws' bite and over the golf ball, in virtual time: the loop
// gives out no energy of its own.
#include <gtest/gtest.h>

#include <array>
#include <iterator>
#include <optional>
#include <random>
#include <string>

#include "host_bake/models/models.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/virtual_loop.hpp"
#include "tools/realtime/coupled_query.hpp"
#include "tools/realtime/engine_query.hpp"
#include "tools/realtime/steady_query.hpp"

namespace palpate::test {
namespace {

/// What the controller may have yet to take back: the energy of the hand, 0.3 kg, at 8 cm/s, and at
/// 12 cm/s in a run fifty times as long. Forces of many contacts are no gradient of anything, and a
/// change of level is a change of surface.
constexpr double kEpsilon_J = PALPATE_TICKS > 100'000 ? 2e-3 : 1e-3;
constexpr std::uint64_t kTicks = effort<std::uint64_t>(PALPATE_TICKS, PALPATE_TICKS / 20);
constexpr double kRate_Hz = 1000;
constexpr std::uint64_t kTicksPerPlace = 200;

struct Place {
  const char* tool;
  const char* other;
  std::size_t triangles;
  Vec3d centre_m;  ///< of where the hand is led
  Vec3d reach_m;   ///< to either side
};

constexpr Place kPlaces[] = {
    {"jaw_upper", "jaw_lower", 6000, {0, 0, 0.001}, {0.002, 0.002, 0.002}},
    {"golf_club", "golf_ball", 6000, {0, -0.0258, -0.006}, {0.004, 0.002, 0.005}},
};

/// Baked once for both couplings.
struct Bodies {
  explicit Bodies(const Place& place)
      : tool(bake::make_model(place.tool, place.triangles)),
        other(bake::make_model(place.other, place.triangles)) {}
  BakedBody tool, other;
};

const Bodies& bodies(std::size_t place) {
  static std::array<std::optional<Bodies>, std::size(kPlaces)> baked;
  if (!baked[place]) baked[place].emplace(kPlaces[place]);
  return *baked[place];
}

/// A new place to go to every fifth of a second, at up to 0.04 m/s, for all of the run.
std::vector<hal::mock::Waypoint> random_script(const Place& place) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<hal::mock::Waypoint> script;
  for (std::uint64_t i = 0; i <= kTicks / kTicksPerPlace; ++i) {
    const Vec3d r = place.reach_m;
    const Pose pose{place.centre_m + Vec3d{r.x * u(rng), r.y * u(rng), r.z * u(rng)},
                    turn({0.02 * u(rng), 0.02 * u(rng), 0.05 * u(rng)})};
    script.push_back({kTicksPerPlace / kRate_Hz * static_cast<double>(i), pose});
  }
  // Begins and ends apart.
  script.front().pose.position_m = script.back().pose.position_m =
      place.centre_m + 4.0 * Vec3d{0, -place.reach_m.y, place.reach_m.z};
  return script;
}

struct Case {
  std::size_t place;
  bool coupled;
};

void PrintTo(const Case& c, std::ostream* os) { *os << kPlaces[c.place].tool; }

class EnergyOfTheLoop : public testing::TestWithParam<Case> {};

TEST_P(EnergyOfTheLoop, is_never_given_out) {
  const Place& place = kPlaces[GetParam().place];
  const Bodies& both = bodies(GetParam().place);
  BakedScene scene({both.tool.view, both.other.view}, {{0, 1}}, {});
  const Pose poses[2] = {};
  realtime::EngineQuery contacts(*scene.engine, poses, 0);
  realtime::SteadyQuery steady(contacts, {}, Settings{}.stiffness_N_per_m, 1 / kRate_Hz);
  realtime::CoupledQuery coupled(contacts, {}, 1 / kRate_Hz);
  realtime::ContactQuery& query =
      GetParam().coupled ? static_cast<realtime::ContactQuery&>(coupled) : steady;

  hal::mock::HandParameters hand;
  hand.script = random_script(place);
  realtime::LoopSettings settings;
  settings.rate_Hz = kRate_Hz;
  settings.periods = kTicks;
  settings.passivity_control = true;
  realtime::test::VirtualLoop rig(
      hand, settings,
      [&](const Pose& at, const Budget&, TickResult& out) {
        return query.tick(at, {.units = 150}, out);
      },
      1);
  const realtime::LoopReport& r = rig.run();
  EXPECT_EQ(r.state, realtime::LoopState::rendering);
  EXPECT_GT(r.touching, kTicks / 10);
  // The few ticks of the thread sanitizer need not come where the budget ends refinement.
  if (kTicks == PALPATE_TICKS) {
    EXPECT_GT(r.truncated, 0u);
  }
  RecordProperty("energy_uJ_min", std::to_string(1e6 * r.energy_J_min));
  RecordProperty("energy_uJ", std::to_string(1e6 * r.energy_J));
  RecordProperty("ticks_touching", std::to_string(r.touching));
  EXPECT_GE(r.energy_J_min, -kEpsilon_J)
      << r.energy_J << " J in all, " << r.touching << " touching";
}

INSTANTIATE_TEST_SUITE_P(Scenes, EnergyOfTheLoop,
                         testing::Values(Case{0, false}, Case{0, true}, Case{1, false},
                                         Case{1, true}),
                         [](const auto& tested) {
                           return std::string(kPlaces[tested.param.place].tool) +
                                  (tested.param.coupled ? "_virtual" : "_direct");
                         });

}  // namespace
}  // namespace palpate::test

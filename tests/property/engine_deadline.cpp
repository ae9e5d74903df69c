// SPDX-License-Identifier: GPL-3.0-or-later
// Nothing but what may be done is done between two looks at the clock and after the deadline. A
// clock that stands still and then jumps tells this exactly, on any machine.
#include <gtest/gtest.h>

#include "host_bake/models/models.hpp"
#include "rt_core/base/pace.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/ground.hpp"

namespace palpate::test {
namespace {

constexpr std::uint64_t kDeadline_ns = 1'000'000;
constexpr std::size_t kTriangles = effort<std::size_t>(1500, 1000);

/// The deadline has passed from one reading on.
struct JumpingClock {
  std::uint64_t late_from = 0;  ///< the first reading is 1
  std::uint64_t readings = 0;
  static std::uint64_t read(void* self) {
    auto& clock = *static_cast<JumpingClock*>(self);
    return ++clock.readings < clock.late_from ? 0 : kDeadline_ns;
  }
};

struct Case {
  const char* name;
  Settings settings;
  std::uint64_t most_units;     ///< between two readings
  std::uint64_t most_readings;  ///< from the late one on
};

constexpr double kDelta_m = 5e-4;
/// The witnesses of all regions that are near are measured together, and so is an edge.
constexpr std::uint64_t kAtOnce = 240 + kUnitsPerReading;
const Case kCases[] = {
    {"levels_exact", {.delta_m = kDelta_m, .exact = true}, kAtOnce, 12},
    {"levels", {.delta_m = kDelta_m, .s0 = 0.01}, kAtOnce, 12},
    {"regions", {.engine = EngineKind::regions, .delta_m = kDelta_m}, kAtOnce, 12},
};

void PrintTo(const Case& c, std::ostream* os) { *os << c.name; }

class EngineDeadline : public testing::TestWithParam<Case> {
 protected:
  static const BakedBody& upper() {
    static const BakedBody body(bake::make_model("jaw_upper", kTriangles), bake::ForEngine::both);
    return body;
  }
  static const BakedBody& lower() {
    static const BakedBody body(bake::make_model("jaw_lower", kTriangles), bake::ForEngine::both);
    return body;
  }
};

struct Late {
  std::uint64_t units = 0;
  std::uint64_t readings = 0;  ///< from the late one on
  bool truncated = false;
};

/// The last of some ticks, of which the ones before have all the time they want.
Late tick_late_from(const Case& test, std::uint64_t reading, const BakedBody& a,
                    const BakedBody& b) {
  BakedScene scene({a.view, b.view}, {{0, 1}}, test.settings, {.nodes = 1u << 12});
  constexpr int kBefore = 3;
  for (int i = 0; i < kBefore; ++i) {
    const Pose poses[2] = {ground(0.1, i), {}};
    tick_or_fail(*scene.engine, poses);
  }
  const Pose poses[2] = {ground(0.1, kBefore + 3), {}};
  JumpingClock clock{.late_from = reading};
  const TickResult r = tick_or_fail(
      *scene.engine, poses,
      {.clock_ns = JumpingClock::read, .clock_context = &clock, .deadline_ns = kDeadline_ns});
  EXPECT_FALSE(r.certificate.contact == ContactStatus::ruled_out);
  return {r.certificate.units_used, clock.readings < reading ? 0 : clock.readings - reading,
          r.certificate.truncated_by_time};
}

/// Up to the reading at which it jumps, ticks are the same: what one does more than the other is
/// what is done between two readings, and after the last the same.
TEST_P(EngineDeadline, is_looked_at_before_every_query) {
  const Case& test = GetParam();
  Late before = tick_late_from(test, 1, upper(), lower());
  std::uint64_t reading = 2;
  std::uint64_t most_units = 0;
  std::uint64_t most_readings = 0;
  for (; before.truncated && reading < 20'000; reading += 1) {
    const Late late = tick_late_from(test, reading, upper(), lower());
    if (late.units > before.units) {
      most_units = std::max(most_units, late.units - before.units);
    }
    most_readings = std::max(most_readings, late.readings);
    before = late;
  }
  RecordProperty("readings", std::to_string(reading));
  RecordProperty("most_units", std::to_string(most_units));
  RecordProperty("most_readings", std::to_string(most_readings));
  EXPECT_FALSE(before.truncated) << "the tick has no end";
  EXPECT_GT(reading, 30u);
  EXPECT_LE(most_units, test.most_units);
  EXPECT_LE(most_readings, test.most_readings);
}

INSTANTIATE_TEST_SUITE_P(Engines, EngineDeadline,
                         testing::ValuesIn(std::begin(kCases) + effort(0, 1), std::end(kCases)),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace palpate::test

// SPDX-License-Identifier: GPL-3.0-or-later
// Ten million ticks of mixed motion: no allocation, no page fault, no byte beyond what
// required_bytes() asked for. PALPATE_TEST_TICKS in the environment asks for another number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "tests/support/allocation_trap.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

int ticks_wanted() {
  const char* wanted = std::getenv("PALPATE_TEST_TICKS");
  return wanted != nullptr ? std::max(1000, std::atoi(wanted)) : 10'000'000;
}

/// Slides, presses, wiggles at 100 Hz, parts and comes back, and jumps to another side.
Pose mixed(int i) {
  const double side = (i / 5000) % 2 == 0 ? 1 : -1;
  const double apart = i % 4000 > 3500 ? 0.001 * (i % 4000 - 3500) : 0;
  const double wiggle = i % 3000 > 2000 ? 0.004 * std::sin(0.628 * i) : 0;
  const double press = 0.05 * std::sin(0.0017 * i);
  return {{side * (1.76 + press + wiggle + apart), 0.3 * std::sin(0.0003 * i),
           0.2 * std::cos(0.0002 * i)},
          turn({0.0003 * (i % 20000), 0.0001 * (i % 20000), 0})};
}

class EngineEndurance : public testing::TestWithParam<EngineKind> {};

TEST_P(EngineEndurance, mixed_ticks_allocate_nothing_fault_nothing_and_stay_in_their_memory) {
  const BakedBody a(bumpy_ball(14, 20, 1), bake::ForEngine::both);
  const BakedBody b(bumpy_ball(16, 16, 0.8), bake::ForEngine::both);
  const Settings settings{
      .engine = GetParam(), .delta_m = 0.05, .s0 = 0.01, .cluster_radius_m = 0.1};
  const Limits limits{.nodes = 1u << 13, .contacts = 1u << 9, .clusters = 1u << 8};
  BakedScene scene({a.view, b.view}, {{0, 1}}, settings, limits);
  constexpr std::size_t kGuard = 4096;
  constexpr unsigned char kMark = 0xa5;
  const std::size_t bytes = required_bytes(scene.scene(), limits, settings.engine);
  const AlignedMemory memory(kGuard + bytes + kGuard);
  std::memset(memory.data.get(), kMark, memory.size);
  ASSERT_EQ(
      create(scene.scene(), settings, limits, memory.span().subspan(kGuard, bytes), scene.engine),
      Status::ok);
  Pose poses[2];
  expect_no_allocation_and_no_fault(
      scene, poses, [&poses](int i) { poses[0] = mixed(i); }, 1000, ticks_wanted());
  for (std::size_t i = 0; i < kGuard; ++i) {
    ASSERT_EQ(memory.span()[i], std::byte{kMark});
    ASSERT_EQ(memory.span()[kGuard + bytes + i], std::byte{kMark});
  }
}

INSTANTIATE_TEST_SUITE_P(engines, EngineEndurance,
                         testing::Values(EngineKind::levels, EngineKind::regions),
                         [](const testing::TestParamInfo<EngineKind>& kind) {
                           return kind.param == EngineKind::levels ? "levels" : "regions";
                         });

}  // namespace
}  // namespace palpate::test

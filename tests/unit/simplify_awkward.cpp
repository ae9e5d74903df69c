// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "simplify_judge.hpp"
#include "simplify_random.hpp"
#include "tests/support/effort.hpp"

namespace palpate::bake {
namespace {

// The first hundred in every run, a thousand in the long one.
#ifdef PALPATE_LONG
constexpr std::uint32_t kFirst = 100, kLast = 1000;
#else
constexpr std::uint32_t kFirst = 0, kLast = test::effort(100u, 10u);
#endif

TEST(Simplify_awkward_meshes, hold_all_invariants_to_the_end) {
  std::size_t levels = 0;
  for (std::uint32_t seed = kFirst; seed < kLast; ++seed) {
    const test::Simplified result = test::simplified(test::awkward_mesh(seed), {0.0, 0});
    ASSERT_EQ(test::judge_levels(result), "") << "seed " << seed;
    levels += result.levels.size();
  }
  EXPECT_GT(levels, kLast - kFirst);
}

}  // namespace
}  // namespace palpate::bake

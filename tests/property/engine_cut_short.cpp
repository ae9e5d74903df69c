// SPDX-License-Identifier: GPL-3.0-or-later
// Answers of a budget that ends a query, and of images without their finest levels.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/answers.hpp"
#include "tests/support/coarse_bodies.hpp"

namespace palpate::test {
namespace {

constexpr int kTicks = 60;
constexpr std::uint64_t kUnlimited = Budget{}.units;

/// In contact and out of it, in slow and in fast steps.
Pose motion(int i) {
  const double u = i < kTicks / 2 ? 0.1 * i : 1.0 * i;
  return {{1.84 + 0.03 * std::sin(0.3 * u), 0.2 * std::sin(0.05 * u), 0.002 * u},
          turn({0.005 * u, 0.002 * u, 0})};
}

Settings simplified(double s0) { return {.delta_m = kDelta, .s0 = s0, .cluster_radius_m = 0.1}; }

Settings exact() { return {.delta_m = kDelta, .exact = true, .cluster_radius_m = 0.1}; }

struct Answer {
  Vec3d force_N;
  double least_m = 0;  ///< delta where nothing touches
  double bound_m = 0;
  std::size_t contacts = 0;
  bool truncated = false;
};

std::vector<Answer> run(const ImageView& a, const Settings& settings,
                        std::uint64_t units = kUnlimited) {
  BakedScene scene({a, bodies().b.view}, {{0, 1}}, settings);
  std::vector<Answer> answers;
  for (int i = 0; i < kTicks; ++i) {
    const Pose poses[2] = {motion(i), {}};
    const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
    EXPECT_LE(r.queries, units);
    answers.push_back({r.wrench.force_N, r.contacts.empty() ? kDelta : r.min_distance_m,
                       r.certificate.error_bound_m, r.contacts.size(), r.certificate.truncated()});
  }
  return answers;
}

TEST(EngineCutShort, certificate_holds_in_images_without_their_finest_levels) {
  bake::BakeOptions options = coarse();
  options.max_bytes = static_cast<std::size_t>(bodies().a.view.header->total_bytes / 2);
  const BakedBody small(bumpy_ball(24, 32, 1), options);
  ASSERT_GT(small.view.header->dropped_levels, 0u);
  const auto s0 = static_cast<double>(small.view.header->s0_min);
  const std::vector<Answer> truth = run(bodies().a.view, exact());
  for (const std::uint64_t units : {std::uint64_t{30}, std::uint64_t{300}, kUnlimited}) {
    const std::vector<Answer> found = run(small.view, simplified(s0), units);
    for (std::size_t i = 0; i < truth.size(); ++i)
      EXPECT_LE(std::abs(found[i].least_m - truth[i].least_m), found[i].bound_m + 1e-6) << i;
  }
}

TEST(EngineCutShort, exact_query_that_ends_in_time_is_not_changed) {
  const std::vector<Answer> limited = run(bodies().a.view, exact(), 1'000'000);
  const std::vector<Answer> unlimited = run(bodies().a.view, exact());
  for (std::size_t i = 0; i < unlimited.size(); ++i) {
    EXPECT_EQ(limited[i].contacts, unlimited[i].contacts);
    // The same contacts, in another order: the sum is rounded otherwise.
    EXPECT_NEAR(norm(limited[i].force_N - unlimited[i].force_N), 0, 1e-12);
  }
}

TEST(EngineCutShort, exact_query_cut_short_loses_no_contact) {
  constexpr std::uint64_t kUnits = 100;
  const std::vector<Answer> truth = run(bodies().a.view, exact());
  const std::vector<Answer> cut = run(bodies().a.view, exact(), kUnits);
  std::size_t truncated = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (cut[i].truncated) ++truncated;
    if (truth[i].contacts > 0) {
      EXPECT_GT(cut[i].contacts, 0u) << "tick " << i;
    }
  }
  EXPECT_GT(truncated, 0u);
}

}  // namespace
}  // namespace palpate::test

// SPDX-License-Identifier: GPL-3.0-or-later
// What a budget that is too small may cost: detail, never a contact that the certificate does not
// speak of.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "tests/support/answers.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/coarse_bodies.hpp"

namespace palpate::test {
namespace {

// A ring about a ball: contacts on several sides at once.
struct RingAboutBall {
  BakedBody a{bumpy_ball(20, 24, 0.62), coarse()};
  BakedBody b{ring(28, 14, 1, 0.35), coarse()};
};

const RingAboutBall& ring_about_ball() {
  static const RingAboutBall both;
  return both;
}

Pose motion(int i) {
  return {{0.03 * std::sin(0.05 * i), 0.03 * std::cos(0.05 * i), 0.004 * std::sin(0.2 * i)},
          turn({0.004 * i, 0.002 * i, 0.006 * i})};
}

/// What is nearer than delta at a pose, by brute force.
struct Near {
  explicit Near(const Pose& pose) : a(ring_about_ball().a.mesh, pose) {
    const PlacedTriangles b(ring_about_ball().b.mesh, {});
    regions = near_regions(ring_about_ball().a.mesh, a, b, 0.98 * kDelta);
    for (const auto& region : regions) {
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t i : region) least = distance_from(a, i, b, least);
      distances.push_back(least);
    }
  }
  [[nodiscard]] bool holds(double distance) const {
    return std::ranges::any_of(distances, [=](double d) { return d <= distance; });
  }
  PlacedTriangles a;
  std::vector<std::vector<std::size_t>> regions;
  std::vector<double> distances;  ///< of the regions
};

constexpr int kPoses = 40;

const Near& near_at(int i) {
  static const std::vector<Near> all = [] {
    std::vector<Near> out;
    for (int k = 0; k < kPoses; ++k) out.emplace_back(motion(k));
    return out;
  }();
  return all.at(static_cast<std::size_t>(i));
}

/// Each region nearer than delta has a contact, or is no nearer than the certificate leaves open.
void expect_no_region_lost(const TickResult& r, const Near& near) {
  const double nearest = r.contacts.empty() ? kDelta : r.min_distance_m;
  const double open_from = nearest - r.certificate.error_bound_m - 2e-6;
  for (std::size_t k = 0; k < near.regions.size(); ++k) {
    double apart = std::numeric_limits<double>::infinity();
    for (const Contact& c : r.contacts)
      apart = std::min(apart, distance_to(near.a, near.regions[k], c.point_a_m));
    if (apart > kDelta) {
      EXPECT_GE(near.distances[k], open_from)
          << "a region of " << near.regions[k].size() << " triangles";
    }
  }
}

TEST(EngineTruncation, every_near_region_has_a_contact_or_is_within_the_certificate) {
  for (const double s0 : {0.0, 0.02}) {
    for (const std::uint64_t units : {1u, 4u, 16u, 64u, 256u, 1024u}) {
      BakedScene scene({ring_about_ball().a.view, ring_about_ball().b.view}, {{0, 1}},
                       {.delta_m = kDelta, .s0 = s0, .cluster_radius_m = 0.1});
      for (int i = 0; i < kPoses; ++i) {
        const Pose poses[2] = {motion(i), {}};
        const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
        expect_no_region_lost(r, near_at(i));
      }
    }
  }
}

/// Ticks in contact of the first `ticks` (at most kPoses), and those of them in which one is felt.
/// The first tick has no budget.
struct Felt {
  int touching = 0;
  int felt = 0;
};

Felt feel(std::uint64_t units, int ticks) {
  BakedScene scene({ring_about_ball().a.view, ring_about_ball().b.view}, {{0, 1}},
                   {.delta_m = kDelta, .s0 = 0.02, .cluster_radius_m = 0.1});
  Felt out;
  for (int i = 0; i < ticks; ++i) {
    const Pose poses[2] = {motion(i), {}};
    const Budget budget = i == 0 ? Budget{} : Budget{.units = units};
    const TickResult r = tick_or_fail(*scene.engine, poses, budget);
    if (!near_at(i).holds(0.5 * kDelta)) continue;
    ++out.touching;
    out.felt += r.contacts.empty() ? 0 : 1;
  }
  return out;
}

// Once found, a contact is felt at its last points while these are within reach of each other,
// whatever the budget.
TEST(EngineTruncation, contact_that_was_found_outlives_the_budget) {
  for (const std::uint64_t units : {0u, 1u, 2u, 4u}) {
    const Felt few = feel(units, 6);
    EXPECT_GE(few.touching, 5);
    EXPECT_EQ(few.felt, few.touching) << units << " units";
  }
}

// From a budget on that leads down to one new contact a tick, it is felt for ever.
TEST(EngineTruncation, contact_is_felt_for_ever_within_a_few_queries_a_tick) {
  for (const std::uint64_t units : {8u, 16u, 32u, 64u, 128u}) {
    const Felt all = feel(units, kPoses);
    EXPECT_GT(all.touching, 10);
    EXPECT_EQ(all.felt, all.touching) << units << " units";
  }
}

}  // namespace
}  // namespace palpate::test

// SPDX-License-Identifier: GPL-3.0-or-later
// The region engine against brute force over all triangles: every region's least distance, bounds
// that hold wherever a search ends, overlap that begins at zero.
#include <gtest/gtest.h>

#include <functional>

#include "rt_core/counters.hpp"
#include "rt_core/engine.hpp"
#include "rt_core/regions/region_state.hpp"
#include "rt_core/regions/sweep.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

constexpr bake::ForEngine kRegions = bake::ForEngine::regions;

/// Distances alone; with a stiffness, the force too.
Settings exact_settings(double delta, double stiffness_N_per_m = 0) {
  return {.engine = EngineKind::regions,
          .delta_m = delta,
          .exact = true,
          .stiffness_N_per_m = stiffness_N_per_m,
          .cluster_radius_m = delta};
}

/// Least distance of each region of a from b, or `most`.
std::vector<double> region_distances(const BakedBody& a, const PlacedTriangles& moved,
                                     const PlacedTriangles& fixed, double most) {
  std::vector<double> least(a.view.regions.size(), most);
  for (const image::RegionTriangle& t : a.view.region_triangles) {
    least[t.region] = distance_from(moved, t.source, fixed, least[t.region]);
  }
  return least;
}

void expect_region_minima(const TickResult& result, std::vector<double> truth, double delta,
                          double unit) {
  std::vector<double> found;
  for (const Contact& c : result.contacts) {
    found.push_back(c.distance_m);
    EXPECT_NEAR(norm(c.point_a_m - c.point_b_m), std::abs(c.distance_m), 1e-6 * unit);
    EXPECT_NEAR(norm(c.normal), 1, 1e-6);
  }
  // Beside delta rounding decides.
  std::erase_if(truth, [&](double d) { return d > delta - 1e-6 * unit; });
  std::sort(truth.begin(), truth.end());
  std::sort(found.begin(), found.end());
  ASSERT_GE(found.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_NEAR(found[i], truth[i], 1e-6 * unit);
  for (std::size_t i = truth.size(); i < found.size(); ++i) {
    EXPECT_NEAR(found[i], delta, 2e-6 * unit);
  }
  EXPECT_LT(result.certificate.error_bound_m, 1e-5 * unit);
}

struct Case {
  const char* name;
  bake::Mesh (*a)();
  bake::Mesh (*b)();
};

void PrintTo(const Case& c, std::ostream* os) { *os << c.name; }

class RegionsExact : public testing::TestWithParam<Case> {};

TEST_P(RegionsExact, minima_of_all_regions_agree_with_brute_force) {
  for (const double scale : {1e-6, 1.0, 1e4}) {
    const BakedBody a(scaled(GetParam().a(), scale), kRegions);
    const BakedBody b(scaled(GetParam().b(), scale), kRegions);
    const double unit = std::max(a.view.header->radius_m, b.view.header->radius_m);
    const double delta = 0.05 * std::min(a.view.header->radius_m, b.view.header->radius_m);
    BakedScene scene({a.view, b.view}, {{0, 1}}, exact_settings(delta));
    const PlacedTriangles fixed(b.mesh, {});
    for_each_placement(a, b, delta, 4, [&](std::span<const Pose> poses) {
      const TickResult result = tick_or_fail(*scene.engine, poses);
      const PlacedTriangles moved(a.mesh, poses[0]);
      expect_region_minima(result, region_distances(a, moved, fixed, 2 * delta), delta, unit);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, RegionsExact,
                         testing::Values(Case{"bumpy_balls", [] { return bumpy_ball(14, 20, 1); },
                                              [] { return bumpy_ball(12, 12, 0.8); }},
                                         Case{"small_on_large", [] { return ball(10, 12, 0.02); },
                                              [] { return bumpy_ball(16, 20, 1); }},
                                         Case{"ball_on_ring", [] { return ball(8, 12, 0.5); },
                                              [] { return ring(20, 10, 1, 0.3); }},
                                         Case{"boxes", [] { return box(0.5, 0.3, 0.2); },
                                              [] { return box(1, 1, 0.1); }},
                                         Case{"open_bowl", [] { return ball(6, 8, 0.3); },
                                              [] { return bowl(6, 12, 1); }}),
                         [](const auto& tested) { return tested.param.name; });

/// Two corners of nine triangles, one above the other, are 81 pairs as near as each other.
TEST(RegionsRest, where_corners_of_many_triangles_meet) {
  const BakedBody body(ball(160, 9, 1), kRegions);
  constexpr double kDelta = 0.002;
  BakedScene scene({body.view, body.view}, {{0, 1}}, exact_settings(kDelta));
  if (counters(*scene.engine) == nullptr) GTEST_SKIP() << "this build counts nothing";
  std::uint64_t contacts = 0;
  for (int i = 0; i < 50; ++i) {
    const Pose moved{{1e-3 * kDelta * i, 0, 2 + 0.5 * kDelta}, {}};
    const Pose poses[] = {moved, {}};
    contacts += tick_or_fail(*scene.engine, poses).contacts.size();
  }
  EXPECT_LT(3 * counters(*scene.engine)->searches, contacts);
}

/// Of surfaces that fit, more comes near on the way than is kept: what is proved is proved all the
/// same.
TEST(RegionsRest, where_more_comes_near_than_there_is_room_for) {
  const BakedBody inner(ball(40, 60, 0.97), kRegions);
  const BakedBody outer(bowl(40, 60, 1), kRegions);
  constexpr double kDelta = 0.05;
  BakedScene scene({inner.view, outer.view}, {{0, 1}}, exact_settings(kDelta));
  for (int i = 0; i < effort(30, 8); ++i) {
    const Pose poses[] = {{{0.02 * kDelta * i - 0.01, 0, 0}, {}}, {}};
    const TickResult result = tick_or_fail(*scene.engine, poses);
    ASSERT_GT(result.contacts.size(), 20u);
    EXPECT_LT(result.certificate.error_bound_m, 1e-5) << i;
  }
}

/// Where bodies that fit are so fast that nothing is known of a region for longer than a tick, a
/// tick costs little more than one that knows nothing.
TEST(RegionsRest, where_nothing_that_is_kept_would_last) {
  bake::BakeOptions options = options_for(kRegions);
  options.delta_rel = 0.005;  // many regions
  constexpr std::uint32_t kRings = effort(80u, 40u);
  const BakedBody inner(ball(kRings, 3 * kRings / 2, 0.97), options);
  const BakedBody outer(bowl(kRings, 3 * kRings / 2, 1), options);
  constexpr double kDelta = 0.05;
  constexpr int kTicks = effort(20, 6);
  BakedScene scene({inner.view, outer.view}, {{0, 1}}, exact_settings(kDelta));
  std::uint64_t units = 0;
  std::uint64_t cold = 0;
  for (int i = 0; i < kTicks; ++i) {
    const Pose poses[] = {{{0.1 * kDelta * i - 0.01, 0, 0}, {}}, {}};
    units += tick_or_fail(*scene.engine, poses).queries;
    BakedScene fresh({inner.view, outer.view}, {{0, 1}}, exact_settings(kDelta));
    cold += tick_or_fail(*fresh.engine, poses).queries;
  }
  EXPECT_LT(100 * units, 145 * cold);
}

/// A body that slides along another, by a fiftieth of delta a tick.
TEST(RegionsRest, where_a_body_keeps_its_course) {
  const BakedBody a(bumpy_ball(40, 56, 1), kRegions);
  const BakedBody b(box(2, 2, 0.5), kRegions);
  constexpr double kDelta = 0.05;
  BakedScene scene({a.view, b.view}, {{0, 1}}, exact_settings(kDelta));
  if (counters(*scene.engine) == nullptr) GTEST_SKIP() << "this build counts nothing";
  std::uint64_t contacts = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose moved{{0.02 * kDelta * i, 0, 1.5}, {}};
    const Pose poses[] = {moved, {}};
    contacts += tick_or_fail(*scene.engine, poses).contacts.size();
  }
  EXPECT_LT(8 * counters(*scene.engine)->searches, contacts);
}

struct Bodies {
  BakedBody a{bumpy_ball(20, 28, 1), kRegions};
  BakedBody b{bumpy_ball(16, 16, 0.8), kRegions};
};

const Bodies& bodies() {
  static const Bodies both;
  return both;
}

/// A pair of the bodies as the search sees it, a at a pose; metres are units, for a's radius is
/// about 1.
struct SearchedPair {
  explicit SearchedPair(const Pose& pose) {
    pair.image_a = &bodies().a.view;
    pair.image_b = &bodies().b.view;
    pair.unit_m = pair.image_a->header->radius_m;
    pair.scale_b = pair.image_b->header->radius_m / pair.unit_m;
    move(pose);
  }
  void move(const Pose& pose) {
    levels::move(pair, pose, {});
    frame = regions::frame_of(pair);
  }
  levels::PairState pair;
  regions::PairFrame frame;
  std::unique_ptr<regions::SearchScratch> scratch = std::make_unique<regions::SearchScratch>();
};

std::vector<double> truth_in_units(const Pose& pose, double unit_m) {
  const PlacedTriangles fixed(bodies().b.mesh, {});
  std::vector<double> truth = region_distances(bodies().a, PlacedTriangles(bodies().a.mesh, pose),
                                               fixed, std::numeric_limits<double>::max());
  for (double& d : truth) d /= unit_m;
  return truth;
}

const Pose kNear{{1.72, 0.2, 0.3}, turn({0.3, 0.2, -0.4})};
constexpr double kRounding = 2e-7;  // of the distances of single triangles

void expect_kept_or_beyond_rest(const regions::Bounds& found, const regions::NearPairs& near,
                                double d) {
  if (near.count > 0) {
    ASSERT_LE(std::min(double(found.rest), double(near.pairs[0].distance) - kRounding), d);
  } else {
    ASSERT_LE(double(found.rest), d);
  }
  for (std::uint32_t i = 1; i < near.count; ++i) {
    ASSERT_LE(near.pairs[i - 1].distance, near.pairs[i].distance);
  }
}

TEST(RegionSearch, bounds_hold_wherever_the_budget_ends_it) {
  SearchedPair at(kNear);
  const std::vector<double> truth = truth_in_units(kNear, at.pair.unit_m);
  for (std::uint32_t region = 0; region < truth.size(); region += 3) {
    const double d = truth[region];
    for (const float margin : {0.0f, -0.01f, 0.01f, -0.1f, -0.3f}) {
      for (const std::uint64_t units : {0u, 1u, 3u, 9u, 20u, 50u, 100000u}) {
        Meter meter({.units = units}, {});
        Pace pace(meter);
        const regions::Bounds found = regions::search(
            regions::best_kernels(), at.frame, *at.scratch, pace, region, {}, {0.5f, margin});
        expect_kept_or_beyond_rest(found, at.scratch->near, d);
        if (found.best.known()) {
          ASSERT_GE(double(found.best.distance), d - kRounding);
        }
        if (!found.complete || d > 0.5 + std::min(0.0, double(margin))) continue;
        ASSERT_TRUE(found.best.known());
        ASSERT_GE(double(found.rest),
                  d + std::min(0.0, double(margin)) - 2 * double(regions::kRounding))
            << region << " " << units;
        if (margin >= 0) {
          ASSERT_NEAR(double(found.best.distance), d, kRounding);
        }
      }
    }
  }
}

/// All pairs of triangles of a region: those kept are no nearer than is said, all others beyond
/// rest.
void expect_pairs_bounded(const SearchedPair& at, const Pose& pose, std::uint32_t region,
                          const regions::Bounds& found) {
  const PlacedTriangles moved(bodies().a.mesh, pose);
  const PlacedTriangles fixed(bodies().b.mesh, {});
  const auto& triangles = bodies().a.view.region_triangles;
  const auto& others = bodies().b.view.region_triangles;
  const regions::NearPairs& near = at.scratch->near;
  const auto end = near.pairs + near.count;
  for (std::uint32_t a = 0; a < triangles.size(); ++a) {
    if (triangles[a].region != region) continue;
    for (std::uint32_t b = 0; b < others.size(); ++b) {
      const regions::Witness pair{a, b, 0};
      const auto kept =
          std::find_if(near.pairs, end, [&](const auto& w) { return w.same_pair(pair); });
      const double d = distance_between(moved, triangles[a].source, fixed, others[b].source);
      ASSERT_GE(d / at.pair.unit_m,
                kept == end ? double(found.rest) : double(kept->distance) - kRounding);
    }
  }
}

TEST(RegionSearch, pairs_that_are_not_kept_are_beyond_rest) {
  SearchedPair at(kNear);
  for (const std::uint32_t region : {2u, 7u, 11u}) {
    Meter meter({}, {});
    Pace pace(meter);
    const regions::Bounds found = regions::search(regions::best_kernels(), at.frame, *at.scratch,
                                                  pace, region, {}, {2.0f, 0.02f});
    expect_pairs_bounded(at, kNear, region, found);
  }
}

/// A course in the world is one of b, which stands in it.
regions::Reach reach_along(const SearchedPair& at, Vec3d course_m) {
  regions::Reach reach{2.0f, 0.02f};
  const double to_image = 1 / (at.pair.unit_m * at.pair.scale_b);
  reach.course = vec_cast<float>(to_image * course_m);
  return reach;
}

Pose shifted(Pose pose, Vec3d by) {
  pose.position_m += by;
  return pose;
}

TEST(RegionSearch, all_along_its_course_what_is_not_kept_is_beyond_rest) {
  std::mt19937 rng(3);
  for (const std::uint32_t region : {2u, 7u, 11u}) {
    for (const double length : {1e-3, 0.05}) {
      const Vec3d course = length * random_unit(rng);
      SearchedPair at(kNear);
      const double least = truth_in_units(kNear, at.pair.unit_m)[region];
      for (const float margin : {0.02f, 0.0f, -0.02f}) {
        for (const std::uint32_t room : {regions::kNearPairs, 4u}) {
          Meter meter({}, {});
          Pace pace(meter);
          regions::Reach reach = reach_along(at, course);
          reach.margin = margin;
          reach.room = room;
          const regions::Bounds found = regions::search(regions::best_kernels(), at.frame,
                                                        *at.scratch, pace, region, {}, reach);
          ASSERT_TRUE(found.complete);
          ASSERT_NEAR(double(found.best.distance), least,
                      std::max(0.0, -double(margin)) + kRounding);
          for (const double part : {0.0, 0.4, 1.0}) {
            expect_pairs_bounded(at, shifted(kNear, part * course), region, found);
          }
        }
      }
    }
  }
}

TEST(RegionSearch, is_given_up_where_more_comes_near_on_the_course_than_there_is_room_for) {
  SearchedPair at(kNear);
  regions::Reach reach = reach_along(at, {-0.1, 0, 0});
  reach.room = 8;
  for (const std::uint32_t region : {2u, 7u, 11u}) {
    std::uint64_t units = 0;
    const auto search = [&](const regions::Witness& witness) {
      Meter meter({}, {});
      Pace pace(meter);
      const regions::Bounds found = regions::search(regions::best_kernels(), at.frame, *at.scratch,
                                                    pace, region, witness, reach);
      units = meter.used();
      return found;
    };
    reach.widest = regions::kFarthest;
    const regions::Witness nearest = search({}).best;
    const regions::Bounds whole = search(nearest);
    const std::uint64_t units_of_whole = units;
    ASSERT_TRUE(whole.complete);
    ASSERT_LT(whole.rest, nearest.distance);
    reach.widest = 0;
    const regions::Bounds found = search(nearest);
    EXPECT_TRUE(found.crowded);
    EXPECT_FALSE(found.complete);
    EXPECT_TRUE(found.best.same_pair(nearest));
    EXPECT_EQ(found.rest, 0);
    EXPECT_LT(units, units_of_whole) << region;
  }
}

TEST(RegionState, what_keeps_to_its_course_has_not_moved) {
  SearchedPair at(kNear);
  constexpr std::uint32_t kRegion = 5;
  const Vec3d course{0.02, -0.01, 0.03};
  const double length = norm(course) / at.pair.unit_m;
  const Vec3d aside = 0.01 * across(course);
  regions::RegionState state;
  regions::RegionPairs kept;
  regions::prove(state, kept, at.pair, kRegion, 1, (1 / at.pair.unit_m) * course);
  const auto moved = [&](Vec3d by) {
    levels::move(at.pair, shifted(kNear, by), {});
    return regions::moved_since(state.at, at.pair, kRegion);
  };
  EXPECT_NEAR(moved({}), 0, 1e-8);
  EXPECT_NEAR(moved(0.6 * course), 0, 1e-8);
  EXPECT_NEAR(moved(course), 0, 1e-8);
  EXPECT_NEAR(moved(0.3 * course + aside), norm(aside) / at.pair.unit_m, 1e-8);
  EXPECT_NEAR(moved(1.5 * course), 0.5 * length, 1e-8);
  EXPECT_NEAR(moved(-0.5 * course), 0.5 * length, 1e-8);
}

TEST(RegionState, no_point_moves_farther_than_is_said) {
  std::mt19937 rng(5);
  for (std::uint32_t round = 0; round < 20; ++round) {
    SearchedPair at(kNear);
    regions::RegionState state;
    regions::RegionPairs kept;
    const std::uint32_t region = round % 7;
    regions::prove(state, kept, at.pair, region, 1);
    const double way_before = regions::way_of(at.pair, region);
    std::vector<Vec3d> before;
    const auto place = [&](const image::RegionTriangle& t) {
      const Vec3d p{double(t.corners[0]), double(t.corners[1]), double(t.corners[2])};
      return transpose(at.pair.b_in_a.rotation) *
             (at.pair.scale_a * p - at.pair.b_in_a.translation);
    };
    for (const auto& t : bodies().a.view.region_triangles) before.push_back(place(t));
    Pose pose = kNear;
    for (int step = 0; step < 5; ++step) {
      pose.position_m += 0.05 * random_unit(rng);
      pose.orientation = turn(0.3 * random_unit(rng));
      levels::move(at.pair, pose, {});
    }
    const double most = regions::moved_since(state.at, at.pair, region);
    const double reach = double(at.pair.image_a->regions[region].reach);
    const double way = regions::way_since(state.at, at.pair, reach);
    EXPECT_NEAR(regions::way_of(at.pair, region) - way_before, way, 2 * regions::kMotionSlack);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto& t = bodies().a.view.region_triangles[i];
      if (t.region != region) continue;
      ASSERT_LE(norm(place(t) - before[i]), most);
      ASSERT_LE(norm(place(t) - before[i]), way);
    }
  }
}

/// What is kept of active regions: how much of it was not measured in a tick.
struct Unmeasured {
  int witnesses = 0;
  int near_pairs = 0;
};

void expect_kept_are_bounded(const BakedScene& s, std::uint64_t active, const Pose& pose,
                             Unmeasured& out) {
  const regions::MinimaMemory& memory = s.engine->minima;
  const levels::PairState& pair = memory.pairs[0];
  const PlacedTriangles moved(bodies().a.mesh, pose);
  const PlacedTriangles fixed(bodies().b.mesh, {});
  const auto truth = [&](const regions::Witness& w) {
    return distance_between(moved, bodies().a.view.region_triangles[w.a].source, fixed,
                            bodies().b.view.region_triangles[w.b].source) /
           pair.unit_m;
  };
  for (const regions::Active& item : memory.active.first(active)) {
    const regions::Witness& witness = memory.witnesses[item.state];
    if (!witness.known()) continue;
    const double distance = double(witness.distance);
    const double exact = truth(witness);
    ASSERT_LE(distance, exact + kRounding);
    ASSERT_GE(distance, std::min(exact, pair.delta) - kRounding);
    out.witnesses += distance < exact - 1e-4 * pair.delta ? 1 : 0;
    const double reach = double(pair.image_a->regions[item.region].reach);
    const double way = regions::way_since(memory.states[item.state].at, pair, reach);
    const regions::RegionPairs& kept = memory.kept[item.state];
    for (std::uint32_t k = 0; k < kept.near.count; ++k) {
      const double by_proof = double(kept.near.pairs[k].distance - item.moved);
      const double by_measure = double(kept.apart[k]) - way;
      ASSERT_LE(std::max(by_proof, by_measure), truth(kept.near.pairs[k]) + kRounding);
      out.near_pairs += by_measure > by_proof && by_measure >= distance ? 1 : 0;
    }
  }
}

TEST(RegionState, what_is_kept_is_measured_or_known_to_be_farther) {
  constexpr double kDelta = 0.05;
  std::mt19937 rng(7);
  Unmeasured unmeasured;
  for (const double speed : {0.02, 0.1, 0.05}) {  // of delta
    const Vec3d steady = speed == 0.05 ? Vec3d{0, 0.6, 0.8} : Vec3d{};
    BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, exact_settings(kDelta));
    Pose pose = kNear;
    for (int i = 0; i < 60; ++i) {
      pose.position_m += speed * kDelta * (random_unit(rng) + steady);
      pose.orientation = pose.orientation * turn(0.3 * speed * kDelta * random_unit(rng));
      const Pose poses[2] = {pose, {}};
      const Budget budget = i % 3 == 0 ? Budget{} : Budget{.units = 200};
      const TickResult tick = tick_or_fail(*scene.engine, poses, budget);
      expect_kept_are_bounded(scene, tick.front_nodes, pose, unmeasured);
    }
  }
  EXPECT_GT(unmeasured.witnesses, 50);
  EXPECT_GT(unmeasured.near_pairs, 50);
}

/// Of what odometers alone would take for near after a while, displacements tell again what is far.
TEST(RegionState, what_goes_to_and_fro_stays_far) {
  constexpr double kDelta = 0.02;
  BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, exact_settings(kDelta));
  const regions::MinimaMemory& memory = scene.engine->minima;
  const levels::PairState& pair = memory.pairs[0];
  int renewed = 0;
  for (int i = 0; i < 200; ++i) {
    const double phase = 0.7 * i;
    Pose pose = kNear;
    pose.position_m += 0.2 * kDelta * Vec3d{std::sin(phase), std::cos(phase), 0};
    pose.orientation = pose.orientation * turn({0, 0, 0.1 * kDelta * std::sin(phase)});
    const Pose poses[2] = {pose, {}};
    tick_or_fail(*scene.engine, poses);
    if (i % 40 != 39) continue;
    const std::vector<double> truth = truth_in_units(pose, pair.unit_m);
    for (std::uint32_t region = 0; region < truth.size(); ++region) {
      const double left = memory.lasting[region] - regions::most_way_of(pair);
      ASSERT_LE(left, truth[region] + kRounding);
      const regions::Stand& at = memory.states[region].at;
      const double since = pair.travel - at.travel;
      renewed += left >= pair.delta && double(memory.states[region].lower) - since < pair.delta;
    }
  }
  EXPECT_GT(renewed, 20);
}

TEST(RegionSweep, bounds_all_regions_from_below_wherever_the_budget_ends_it) {
  SearchedPair at(kNear);
  const std::vector<double> truth = truth_in_units(kNear, at.pair.unit_m);
  std::vector<float> swept(truth.size());
  for (const std::uint64_t units : {0u, 5u, 50u, 100000u}) {
    Meter meter({.units = units}, {});
    Pace pace(meter);
    regions::sweep(regions::best_kernels(), at.frame, *at.scratch, pace, 0.1f, swept);
    int told_apart = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double lower = std::sqrt(double(swept[i]));
      ASSERT_LE(lower - double(regions::kRounding), truth[i]);
      told_apart += lower >= 0.1 ? 1 : 0;
    }
    if (units == 100000) {
      EXPECT_GT(told_apart, int(truth.size()) / 2);
    }
  }
}

TEST(RegionsExact, moving_both_bodies_turns_the_wrench_with_them) {
  const Settings settings = exact_settings(0.05, 600);
  BakedScene one({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
  BakedScene other({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
  expect_wrench_turns_with_the_world(one, other, 50, slid);
}

}  // namespace
}  // namespace palpate::test

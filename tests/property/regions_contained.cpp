// SPDX-License-Identifier: GPL-3.0-or-later
// One body wholly inside another: no triangles cross, and yet they overlap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <random>

#include "host_bake/models/models.hpp"
#include "rt_core/engine.hpp"
#include "rt_core/regions/containment.hpp"
#include "rt_core/regions/region_triangle.hpp"
#include "tests/support/answers.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"
#include "tests/unit/mesh_support.hpp"

namespace palpate::test {
namespace {

constexpr bake::ForEngine kRegions = bake::ForEngine::regions;
constexpr double kDelta = 0.02;

Settings settings() {
  return {
      .engine = EngineKind::regions, .delta_m = kDelta, .exact = true, .cluster_radius_m = kDelta};
}

using bake::testing::inside_out;
using bake::testing::together;

bake::Mesh shifted(bake::Mesh mesh, Vec3d by) {
  for (bake::Point& p : mesh.points) p = {p[0] + by.x, p[1] + by.y, p[2] + by.z};
  return mesh;
}

struct Small {
  BakedBody body{ball(8, 10, 0.1), kRegions};
};

TickResult tick_at(BakedScene& scene, Vec3d at) {
  const Pose poses[2] = {{at, {}}, {}};
  return tick_or_fail(*scene.engine, poses);
}

void expect_pushed_out(const TickResult& r, Vec3d out) {
  ASSERT_FALSE(r.contacts.empty());
  EXPECT_LT(r.min_distance_m, 0);
  EXPECT_GT(dot(r.wrench.force_N, out), 0);
  for (const Contact& c : r.contacts) EXPECT_NEAR(norm(c.normal), 1, 1e-6);
}

TEST(RegionsContained, small_body_inside_a_large_one_is_pushed_out_the_nearest_way) {
  const Small small;
  const BakedBody large(box(1, 1, 1), kRegions);
  BakedScene scene({small.body.view, large.view}, {{0, 1}}, settings());
  for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}}) {
    const Vec3d aside{0.02, 0.03, 0.01};
    expect_pushed_out(tick_at(scene, 0.7 * axis + aside), axis);    // deep: nothing within delta
    expect_pushed_out(tick_at(scene, 0.885 * axis + aside), axis);  // just below the surface
    EXPECT_TRUE(tick_at(scene, 1.5 * axis + aside).contacts.empty());
  }
}

/// A ray through a body may take more units than a tick has, and what it has told is asked again
/// as the bodies move: the way out stays known meanwhile.
TEST(RegionsContained, small_budget_does_not_rule_out_what_it_has_no_time_to_look_for) {
  const BakedBody small(gear(12, 0.1, 0.05), kRegions);
  const BakedBody large(gear(40, 1, 0.6), kRegions);
  constexpr int kTicks = 50;
  constexpr std::uint64_t kFewest = 16;  // units of sixteen looks and their batch, and some more
  for (const std::uint64_t units : {1u, 4u, 16u, 32u, 64u, 128u, 256u}) {
    BakedScene scene({small.view, large.view}, {{0, 1}}, settings());
    int found = 0;
    int lost = 0;
    for (int i = 0; i < kTicks; ++i) {
      const Pose poses[2] = {{{0.4, 0.03, 1e-4 * i}, {}}, {}};
      const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
      EXPECT_NE(r.certificate.contact, ContactStatus::ruled_out) << units;
      found += r.contacts.empty() ? 0 : 1;
      lost += r.contacts.empty() && found > 0 ? 1 : 0;
    }
    EXPECT_EQ(lost, 0) << units;
    if (units >= kFewest) {
      EXPECT_GT(found, kTicks / 2) << units;
    }
  }
}

TEST(RegionsContained, what_was_asked_before_a_jump_does_not_tell_where_a_body_is_after_it) {
  const BakedBody small(gear(12, 0.1, 0.05), kRegions);
  const BakedBody large(gear(40, 1, 0.6), kRegions);
  for (const std::uint64_t units : {16u, 64u, 256u}) {
    for (int asked = 1; asked < 8; ++asked) {
      BakedScene scene({small.view, large.view}, {{0, 1}}, settings());
      const Pose inside[2] = {{{0.4, 0.03, 0}, {}}, {}};
      const Pose outside[2] = {{{0.8, 0.03, 0}, {}}, {}};
      for (int i = 0; i < asked; ++i) tick_or_fail(*scene.engine, inside, {.units = 16});
      EXPECT_TRUE(tick_or_fail(*scene.engine, outside, {.units = units}).contacts.empty());
    }
  }
}

/// What moves by more than it is wide may be on either side, with no tick in which it crosses.
TEST(RegionsContained, what_passes_through_a_surface_between_two_ticks_is_inside) {
  const BakedBody small(ball(8, 10, 0.01), kRegions);
  const BakedBody large(box(1, 1, 1), kRegions);
  Settings thin = settings();
  thin.delta_m = 0.002;
  for (const std::uint64_t units : {Budget{}.units, std::uint64_t{500}, std::uint64_t{100}}) {
    BakedScene scene({small.view, large.view}, {{0, 1}}, thin);
    for (int i = 0; i < 20; ++i) {
      const double z = 1.2 - 0.031 * (i < 12 ? i : 24 - i);
      const Pose poses[2] = {{{0.02, 0.03, z}, {}}, {}};
      const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
      EXPECT_EQ(r.certificate.contact == ContactStatus::found, z < 1) << z << " with " << units;
    }
  }
}

/// Ways through each other, with steps from a tenth of delta to what counts as a jump, against
/// exact answers that know nothing of the tick before.
void expect_no_way_is_denied(const std::vector<BakedBody>& small,
                             const std::vector<BakedBody>& large, int ways) {
  constexpr double kThin = 0.004;
  Settings thin = settings();
  thin.delta_m = kThin;
  struct Count {
    std::uint64_t units;
    int denied = 0, missed = 0, made_up = 0;
  };
  Count counts[] = {{Budget{}.units}, {2000}, {300}, {60}};
  int contained = 0;
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> from_0_to_1;
  const auto tick_of = [&](int way) {
    const BakedBody& a = small[std::size_t(way) % small.size()];
    const BakedBody& b = large[std::size_t(way) / small.size() % large.size()];
    const auto scene = [&] { return BakedScene({a.view, b.view}, {{0, 1}}, thin); };
    std::vector<BakedScene> scenes;
    while (scenes.size() < std::size(counts)) scenes.push_back(scene());
    const double length = kThin * std::pow(10, -1 + 2.2 * from_0_to_1(rng));
    const Vec3d step = length * random_unit(rng);
    const Quat turned = turn(length * from_0_to_1(rng) * random_unit(rng));
    const double from_centre = b.view.header->radius_m * (0.5 + 0.6 * from_0_to_1(rng));
    Pose pose{from_centre * random_unit(rng), turn(3.0 * random_unit(rng))};
    constexpr int kTicks = 40;
    pose.position_m -= 0.5 * kTicks * step;
    for (int t = 0; t < kTicks; ++t) {
      const Pose poses[2] = {pose, {}};
      const TickResult truth = tick_or_fail(*scene().engine, poses);
      const bool touches = !truth.contacts.empty();
      const double distance = !touches ? kThin : std::max(0.0, truth.min_distance_m);
      contained += touches && truth.min_distance_m < -kThin ? 1 : 0;
      for (std::size_t k = 0; k < scenes.size(); ++k) {
        Count& count = counts[k];
        const TickResult r = tick_or_fail(*scenes[k].engine, poses, {.units = count.units});
        expect_certified(r, distance, kThin);
        if (!r.contacts.empty()) {
          EXPECT_LE(std::abs(std::max(0.0, r.min_distance_m) - distance),
                    r.certificate.error_bound_m + 2e-6);
        }
        count.denied += touches && r.certificate.contact == ContactStatus::ruled_out ? 1 : 0;
        count.missed += touches && r.contacts.empty() ? 1 : 0;
        count.made_up += !touches && !r.contacts.empty() ? 1 : 0;
      }
      pose.position_m += step;
      pose.orientation = turned * pose.orientation;
    }
  };
  for (int way = 0; way < ways; ++way) tick_of(way);
  testing::Test::RecordProperty("contained", contained);
  EXPECT_GT(contained, 10 * ways);
  for (const Count& c : counts) {
    testing::Test::RecordProperty("missed_" + std::to_string(c.units), c.missed);
    testing::Test::RecordProperty("made_up_" + std::to_string(c.units), c.made_up);
    EXPECT_EQ(c.denied, 0) << c.units;
    if (c.units >= 2000) {
      EXPECT_EQ(c.missed, 0) << c.units;
      EXPECT_EQ(c.made_up, 0) << c.units;
    }
  }
}

TEST(RegionsContained, no_way_in_is_denied_and_no_way_out) {
  std::vector<BakedBody> large;
  large.emplace_back(bumpy_ball(24, 30, 1), kRegions);
  large.emplace_back(gear(12, 1, 0.4), kRegions);
  large.emplace_back(bake::make_model("golf_shell", 4'000), kRegions);
  std::vector<BakedBody> small;
  small.emplace_back(ball(6, 8, 0.01), kRegions);
  small.emplace_back(gear(6, 0.04, 0.02), kRegions);
  small.emplace_back(bumpy_ball(10, 12, 0.2), kRegions);
  expect_no_way_is_denied(small, large, effort(90, 9));
}

TEST(RegionsContained, no_way_of_one_component_among_several_is_denied) {
  std::vector<BakedBody> large;
  large.emplace_back(together(bumpy_ball(24, 30, 1), inside_out(ball(12, 16, 0.6))), kRegions);
  large.emplace_back(together(gear(12, 0.5, 0.4), shifted(box(0.5, 0.4, 0.4), {0, 1.2, 0})),
                     kRegions);
  std::vector<BakedBody> small;
  small.emplace_back(together(ball(6, 8, 0.01), shifted(ball(6, 8, 0.012), {0, 0, 0.4})), kRegions);
  small.emplace_back(ball(6, 8, 0.02), kRegions);
  small.emplace_back(together(gear(6, 0.04, 0.02), shifted(ball(4, 6, 0.02), {0.1, 0.02, 0})),
                     kRegions);
  expect_no_way_is_denied(small, large, effort(60, 6));
}

TEST(RegionsContained, large_body_around_a_small_one_is_pushed_off_it) {
  const Small small;
  const BakedBody large(box(1, 1, 1), kRegions);
  BakedScene scene({large.view, small.body.view}, {{0, 1}}, settings());
  expect_pushed_out(tick_at(scene, {0.7, 0.02, 0.03}), {1, 0, 0});
}

TEST(RegionsContained, slow_way_in_is_noticed_and_the_way_out_too) {
  const Small small;
  const BakedBody large(box(1, 1, 1), kRegions);
  BakedScene scene({small.body.view, large.view}, {{0, 1}}, settings());
  for (double z = 1.13; z > 0.6; z -= 0.005) {
    const TickResult r = tick_at(scene, {0.02, 0.03, z});
    if (z < 1.09) {
      ASSERT_FALSE(r.contacts.empty()) << z;
      EXPECT_GT(r.wrench.force_N.z, 0) << z;
    }
  }
  for (double z = 0.6; z < 1.13; z += 0.005) {
    const TickResult r = tick_at(scene, {0.02, 0.03, z});
    if (z < 1.09) {
      ASSERT_FALSE(r.contacts.empty()) << z;
      EXPECT_GT(r.wrench.force_N.z, 0) << z;
    }
  }
  EXPECT_GT(tick_at(scene, {0.02, 0.03, 1.115}).min_distance_m, 0);
}

TEST(RegionsContained, rooms_and_open_surfaces_have_no_inside) {
  const Small small;
  const BakedBody room(inside_out(box(1, 1, 1)), kRegions);
  const BakedBody open(bowl(8, 16, 1.2), kRegions);
  for (const BakedBody* around : {&room, &open}) {
    BakedScene scene({small.body.view, around->view}, {{0, 1}}, settings());
    EXPECT_TRUE(tick_at(scene, {0.02, 0.03, 0.01}).contacts.empty());
  }
}

TEST(RegionsContained, wall_of_a_shell_is_inside_and_its_cavity_is_not) {
  const BakedBody small(ball(6, 8, 0.04), kRegions);
  const BakedBody around(together(ball(12, 16, 1), inside_out(ball(12, 16, 0.7))), kRegions);
  BakedScene scene({small.view, around.view}, {{0, 1}}, settings());
  EXPECT_TRUE(tick_at(scene, {0.02, 0.03, 0.01}).contacts.empty());
  expect_pushed_out(tick_at(scene, {0.9, 0.01, 0.02}), {1, 0, 0});
  expect_pushed_out(tick_at(scene, {0.78, 0.01, 0.02}), {-1, 0, 0});
}

/// Two balls and a bar beside them, in one body: whichever of them is inside the box.
TEST(RegionsContained, component_of_a_body_is_pushed_out_by_itself) {
  const Vec3d at[] = {{0, 0, 0}, {3, 0, 0}, {-3, 0, 0.02}};
  const bake::Mesh balls =
      together(shifted(ball(8, 10, 0.1), at[0]), shifted(ball(6, 8, 0.12), at[1]));
  const BakedBody parts(together(balls, shifted(box(0.1, 0.4, 0.1), at[2])), kRegions);
  const BakedBody large(box(1, 1, 1), kRegions);
  ASSERT_EQ(parts.view.header->source_components, 3u);
  for (const std::uint64_t units : {Budget{}.units, std::uint64_t{1000}}) {
    for (const Vec3d inside : at) {
      for (const bool parts_move : {true, false}) {
        SCOPED_TRACE(std::to_string(units) + " units, " + std::to_string(inside.x) +
                     (parts_move ? ", moving" : ", still"));
        const ImageView views[] = {parts.view, large.view};
        BakedScene scene({views[parts_move ? 0 : 1], views[parts_move ? 1 : 0]}, {{0, 1}},
                         settings());
        const auto tick = [&](Vec3d component_at) {
          const Vec3d aside = component_at - inside;
          const Pose poses[2] = {{parts_move ? aside : -aside, {}}, {}};
          return tick_or_fail(*scene.engine, poses, {.units = units});
        };
        TickResult r = tick({0.02, 0.03, 0.7});
        for (int i = 0; i < 3; ++i) r = tick({0.02, 0.03, 0.7});
        expect_pushed_out(r, {0, 0, parts_move ? 1.0 : -1.0});
        EXPECT_NEAR(r.min_distance_m, -0.2, 0.03);
        EXPECT_TRUE(tick({0.02, 0.03, 1.5}).contacts.empty());
      }
    }
  }
}

/// Balls in a row, one body, each a little lower than the one before, and a box that they go into.
class Row {
 public:
  explicit Row(int balls) : large_(box(1, 1, 1), kRegions) {
    bake::Mesh row;
    for (int i = 0; i < balls; ++i) {
      at_.push_back({0.9 - 1.8 * (i + 0.5) / balls, 0.01, -0.002 * i});
      balls_.push_back(shifted(ball(6, 8, 0.4 / balls), at_.back()));
      row = i > 0 ? together(row, balls_.back()) : balls_.back();
    }
    row_ = std::make_unique<BakedBody>(row, kRegions);
  }

  [[nodiscard]] BakedScene scene(bool row_moves) const {
    const ImageView views[] = {row_->view, large_.view};
    return {{views[row_moves ? 0 : 1], views[row_moves ? 1 : 0]}, {{0, 1}}, settings()};
  }

  /// Calls with a tick for each of some budgets, and with the row and the box as what moves.
  /// @param call  called as call(tick, row_moves); tick(by): of the row by so much off the box
  void with_each(std::initializer_list<std::uint64_t> budgets, auto call) const {
    for (const std::uint64_t units : budgets) {
      for (const bool row_moves : {true, false}) {
        SCOPED_TRACE(std::to_string(units) + " units" + (row_moves ? ", moving" : ", still"));
        BakedScene both = scene(row_moves);
        call(
            [&](Vec3d by) {
              const Pose poses[2] = {{row_moves ? by : -by, {}}, {}};
              return tick_or_fail(*both.engine, poses, {.units = units});
            },
            row_moves);
      }
    }
  }

  /// How many balls are felt deeper than delta, by one contact each.
  /// @param by  of the row off the box
  [[nodiscard]] int felt(const TickResult& r, bool row_moves, Vec3d by) const {
    int felt = 0;
    for (const Contact& c : r.contacts) {
      const Vec3d inside = (row_moves ? c.point_a_m : c.point_b_m) - (row_moves ? by : Vec3d{});
      const auto is_near = [&](Vec3d ball_at) {
        return norm(inside - ball_at) < 0.45 / static_cast<double>(at_.size());
      };
      felt += c.distance_m < -kDelta ? static_cast<int>(std::ranges::count_if(at_, is_near)) : 0;
    }
    return felt;
  }

  /// Each ball that is deep inside has one contact, as deep as brute force finds it.
  void expect_depths(const TickResult& r, Vec3d by) const {
    const PlacedTriangles around(large_.mesh, {});
    for (const bake::Mesh& one : balls_) {
      const double depth = distance_of(PlacedTriangles(one, {by, {}}), around);
      const auto is_its = [&](const Contact& c) { return std::abs(c.distance_m + depth) < 1e-6; };
      EXPECT_EQ(std::ranges::count_if(r.contacts, is_its), 1) << depth;
    }
  }

 private:
  BakedBody large_;
  std::vector<Vec3d> at_;
  std::vector<bake::Mesh> balls_;
  std::unique_ptr<BakedBody> row_;
};

TEST(RegionsContained, all_components_that_are_inside_are_felt) {
  constexpr int kBalls = 3;
  const Row row(kBalls);
  row.with_each({Budget{}.units, 1000, 300}, [&](auto tick, bool row_moves) {
    const Vec3d deep{0, 0, 0.7};
    TickResult r = tick(deep);
    for (int i = 0; i < 4; ++i) r = tick(deep);
    EXPECT_EQ(row.felt(r, row_moves, deep), kBalls);
    EXPECT_EQ(r.contacts.size(), static_cast<std::size_t>(kBalls));
    row.expect_depths(r, deep);
    EXPECT_GT(r.wrench.force_N.z * (row_moves ? 1 : -1), 0);
    EXPECT_NEAR(r.wrench.torque_Nm.y, 0, 0.2 * norm(r.wrench.force_N));
    // One of them leaves the box at its side.
    const Vec3d aside = deep + Vec3d{0.6, 0, 0};
    for (int i = 0; i < 4; ++i) r = tick(aside);
    EXPECT_EQ(row.felt(r, row_moves, aside), kBalls - 1);
    EXPECT_TRUE(tick({0, 0, 1.5}).contacts.empty());
  });
}

/// The last ball goes out through the box's side; that it crosses that does not end what the others
/// feel.
TEST(RegionsContained, components_inside_are_felt_beside_one_that_crosses) {
  constexpr int kBalls = 3;
  constexpr double kStep = 0.25 * kDelta;
  const Row row(kBalls);
  row.with_each({Budget{}.units, 2000}, [&](auto tick, bool row_moves) {
    Vec3d by{0, 0, 0.6};
    for (int i = 0; i < 4; ++i) tick(by);
    int crossed = 0;
    double before_N = 0;
    for (; by.x < 0.6; by.x += kStep) {
      const TickResult r = tick(by);
      const int deep = row.felt(r, row_moves, by);
      ASSERT_GE(deep, kBalls - 1) << by.x;
      const double up_N = r.wrench.force_N.z * (row_moves ? 1 : -1);
      const bool jumps = by.x > 0 && std::abs(up_N - before_N) > 0.1 * before_N;
      EXPECT_FALSE(jumps) << by.x << ": " << before_N << " N, then " << up_N;
      before_N = up_N;
      crossed += r.contacts.size() > static_cast<std::size_t>(deep) ? 1 : 0;
    }
    EXPECT_GT(crossed, 10);
  });
}

/// What a budget has in reserve is for a first contact, not for what else may be inside.
TEST(RegionsContained, reserve_is_not_for_a_second_component) {
  const Row row(12);
  BakedScene scene = row.scene(true);
  const Pose poses[2] = {{{0, 0, 0.5}, {}}, {}};
  const Budget budget{.units = 40, .reserve_units = 1'000'000};
  int drawn = 0;
  for (int i = 0; i < 30; ++i) {
    const TickResult r = tick_or_fail(*scene.engine, poses, budget);
    EXPECT_FALSE(r.contacts.empty());
    drawn += r.certificate.on_reserve ? 1 : 0;
  }
  EXPECT_LE(drawn, 1);
}

TEST(RegionsContained, more_components_inside_than_there_is_room_for_leave_the_question_open) {
  constexpr int kBalls = regions::kMostContained + 4;
  const Row row(kBalls);
  BakedScene scene = row.scene(true);
  const TickResult r = tick_at(scene, {0, 0, 0.5});
  EXPECT_EQ(row.felt(r, true, {0, 0, 0.5}), static_cast<int>(regions::kMostContained));
  EXPECT_GT(r.certificate.error_bound_m, kDelta);
  EXPECT_TRUE(tick_at(scene, {0, 0, 1.5}).contacts.empty());
}

TEST(RegionsContained, component_beside_the_one_inside_stays_outside) {
  const bake::Mesh inner = shifted(ball(8, 10, 0.1), {0, 0, -0.9});
  for (const bool inner_first : {true, false}) {
    const bake::Mesh outer = ball(8, 10, 0.1);
    const BakedBody parts(inner_first ? together(inner, outer) : together(outer, inner), kRegions);
    const BakedBody large(box(1, 1, 1), kRegions);
    BakedScene scene({parts.view, large.view}, {{0, 1}}, settings());
    const TickResult r = tick_at(scene, {0.02, 0.03, 1.1 + 0.5 * kDelta});
    int outside = 0;
    int inside = 0;
    for (const Contact& c : r.contacts) {
      outside += c.distance_m > 0 && c.centre_m.z > 1 ? 1 : 0;
      inside += c.distance_m < -kDelta && c.centre_m.z < 1 ? 1 : 0;
    }
    EXPECT_GT(outside, 0);
    EXPECT_EQ(inside, 1);
    EXPECT_EQ(static_cast<std::size_t>(outside + inside), r.contacts.size());
  }
}

TEST(RegionsContained, side_of_a_point_is_that_of_the_shape) {
  const BakedBody body(bumpy_ball(24, 30, 1), kRegions);
  const double radius = body.view.header->radius_m;
  const double* centre = body.view.header->centre_m;
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> coordinate(-1.4, 1.4);
  int inside = 0;
  int seen_inside = 0;
  Vec3d last{2, 0, 0};
  regions::Side last_side = regions::Side::outside;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p{coordinate(rng), coordinate(rng), coordinate(rng)};
    const double distance = norm(radius * p + Vec3d{centre[0], centre[1], centre[2]});
    if (distance > 0.7 && distance < 1.3) continue;  // the bumps are here
    // In as many ticks as it takes: all at once, of seven units, of one.
    regions::Side side = regions::Side::unknown;
    regions::SideQuestion question{.point = p, .walk = {}};
    while (side == regions::Side::unknown) {
      Meter meter({.units = i % 3 == 0 ? Budget{}.units : i % 3 == 1 ? 7u : 1u}, {});
      Pace pace(meter);
      side = regions::side_of(regions::best_kernels(), body.view, question, pace);
    }
    Meter meter({}, {});
    Pace pace(meter);
    ASSERT_EQ(side, distance < 1 ? regions::Side::inside : regions::Side::outside) << i;
    inside += side == regions::Side::inside;
    const bool seen = regions::in_sight(regions::best_kernels(), body.view, last, p, pace);
    if (side != last_side) {
      EXPECT_FALSE(seen) << i;
    } else if (side == regions::Side::inside) {
      EXPECT_TRUE(seen) << i;
      ++seen_inside;
    }
    last = p;
    last_side = side;
  }
  EXPECT_GT(seen_inside, 0);
  EXPECT_GT(inside, 30);
}

/// A tetrahedron with a corner in the origin; of its normals there one may look nearly the opposite
/// way of what is outside.
bake::Mesh corner_of(const Vec3d (&edges)[3]) {
  bake::Mesh m;
  m.points.push_back({0, 0, 0});
  for (const Vec3d& e : edges) m.points.push_back({e.x, e.y, e.z});
  m.faces = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  return dot(cross(edges[0], edges[1]), edges[2]) > 0 ? m : inside_out(m);
}

TEST(RegionsContained, what_is_before_a_sharp_corner_is_outside) {
  constexpr double kGap = 0.3 * kDelta;
  const BakedBody tool(ball(4, 6, 0.1), kRegions);
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> thin(0.05, 1);
  for (int body = 0; body < 60; ++body) {
    const Vec3d axis = random_unit(rng);
    Vec3d edges[3];
    for (Vec3d& e : edges) {
      e = axis + thin(rng) * random_unit(rng);
      e = (1 / norm(e)) * e;
    }
    if (std::abs(dot(cross(edges[0], edges[1]), edges[2])) < 1e-3) continue;
    const BakedBody needle(corner_of(edges), kRegions);
    BakedScene scene({tool.view, needle.view}, {{0, 1}}, settings());
    for (int i = 0; i < 40; ++i) {
      const Vec3d out = random_unit(rng);
      if (dot(out, edges[0]) > 0 || dot(out, edges[1]) > 0 || dot(out, edges[2]) > 0) continue;
      const Pose poses[2] = {approach(tool.mesh, needle.mesh, kGap, 1, out, {}), {}};
      const TickResult r = tick_or_fail(*scene.engine, poses);
      ASSERT_FALSE(r.contacts.empty()) << body << ' ' << i;
      EXPECT_NEAR(r.min_distance_m, kGap, 0.01 * kGap) << body << ' ' << i;
      for (const Contact& c : r.contacts) EXPECT_GT(c.distance_m, 0) << body << ' ' << i;
    }
  }
}

/// The same with two triangles of no area along the edges from there to 1 and 3.
bake::Mesh needles_at(const Vec3d (&edges)[3]) {
  bake::Mesh m = corner_of(edges);
  const bool turned = m.faces[0][1] == 1;
  m.points.push_back({1e-17, 0, 0});
  m.faces[2] = turned ? bake::Face{4, 3, 1} : bake::Face{4, 1, 3};
  m.faces.push_back(turned ? bake::Face{0, 4, 1} : bake::Face{0, 1, 4});
  m.faces.push_back(turned ? bake::Face{0, 3, 4} : bake::Face{0, 4, 3});
  return m;
}

/// The same with one of no area along the edge to 1, whose middle is a corner of it.
bake::Mesh cap_at(const Vec3d (&edges)[3]) {
  bake::Mesh m = corner_of(edges);
  const bool turned = m.faces[0][1] == 1;
  m.points.push_back({0.5 * edges[0].x, 0.5 * edges[0].y, 0.5 * edges[0].z});
  m.faces[0] = turned ? bake::Face{0, 4, 2} : bake::Face{0, 2, 4};
  m.faces.push_back(turned ? bake::Face{4, 1, 2} : bake::Face{4, 2, 1});
  m.faces.push_back(turned ? bake::Face{1, 4, 0} : bake::Face{1, 0, 4});
  return m;
}

TEST(RegionsContained, triangles_without_area_do_not_tell_a_side) {
  constexpr double kGap = 0.3 * kDelta;
  const BakedBody tool(ball(4, 6, 0.1), kRegions);
  std::mt19937 rng(5);
  for (int body = 0; body < 60; ++body) {
    const Vec3d edges[3] = {random_unit(rng), random_unit(rng), random_unit(rng)};
    if (std::abs(dot(cross(edges[0], edges[1]), edges[2])) < 0.05) continue;
    bake::Mesh mesh = body % 2 == 0 ? needles_at(edges) : cap_at(edges);
    // Some place on the edge that they lie along, or its ends, becomes the origin.
    const Vec3d place = 0.125 * (body / 2 % 9) * edges[0];
    for (auto& [x, y, z] : mesh.points) {
      x -= place.x;
      y -= place.y;
      z -= place.z;
    }
    const BakedBody slivers(std::move(mesh), kRegions);
    BakedScene scene({tool.view, slivers.view}, {{0, 1}}, settings());
    const PlacedTriangles fixed(slivers.mesh, {});
    for (int i = 0; i < 20; ++i) {
      const Pose poses[2] = {approach(tool.mesh, slivers.mesh, kGap, 3, random_unit(rng), {}), {}};
      const TickResult r = tick_or_fail(*scene.engine, poses);
      ASSERT_FALSE(r.contacts.empty()) << body << ' ' << i;
      const double truth = distance_of(PlacedTriangles(tool.mesh, poses[0]), fixed);
      EXPECT_NEAR(r.min_distance_m, truth, 1e-6) << body << ' ' << i;
      for (const Contact& c : r.contacts) EXPECT_GT(c.distance_m, 0) << body << ' ' << i;
    }
  }
}

/// A tip in the origin.
bake::Mesh cone(std::uint32_t sides, double radius, double height) {
  bake::Mesh m;
  m.points = {{0, 0, 0}, {0, 0, -height}};
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    m.points.push_back({radius * std::cos(angle), radius * std::sin(angle), -height});
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t here = 2 + i, next = 2 + (i + 1) % sides;
    m.faces.push_back({0, here, next});
    m.faces.push_back({1, next, here});
  }
  return m;
}

TEST(RegionsContained, what_is_before_a_tip_of_many_triangles_is_outside) {
  constexpr double kGap = 0.3 * kDelta;
  constexpr double kRadius = 0.3;
  const BakedBody tool(ball(4, 6, 0.1), kRegions);
  for (const std::uint32_t sides : {60u, 100u, 300u}) {
    const BakedBody tip(cone(sides, kRadius, 1), kRegions);
    BakedScene scene({tool.view, tip.view}, {{0, 1}}, settings());
    std::mt19937 rng(3);
    for (int i = 0; i < 40; ++i) {
      const Vec3d out = random_unit(rng);
      if (out.z < kRadius * std::hypot(out.x, out.y)) continue;  // the tip is not the nearest
      const Pose poses[2] = {approach(tool.mesh, tip.mesh, kGap, 1, out, {}), {}};
      const TickResult r = tick_or_fail(*scene.engine, poses);
      ASSERT_FALSE(r.contacts.empty()) << sides << ' ' << i;
      for (const Contact& c : r.contacts) EXPECT_GT(c.distance_m, 0) << sides << ' ' << i;
    }
  }
}

/// The bottom of a box that is pressed into a block crosses nothing.
TEST(RegionsContained, block_that_crosses_itself_elsewhere_has_an_inside) {
  constexpr double kDeep = 0.5 * kDelta;
  const BakedBody tool(quartered(box(0.1, 0.1, 0.1), 3), kRegions);
  bake::Mesh mesh = quartered(box(1, 1, 1), 4);
  for (bake::Point& p : mesh.points) {
    if (p == bake::Point{0.5, 0.5, -1}) p[2] = 1.2;  // through the upper side
  }
  const BakedBody block(std::move(mesh), kRegions);
  ASSERT_NE(block.view.header->source_crossings, 0u);
  BakedScene scene({tool.view, block.view}, {{0, 1}}, settings());
  for (const Vec3d at : {Vec3d{-0.51, -0.52, 1.1}, Vec3d{-0.73, 0.13, 1.1}}) {
    const Pose in[2] = {{at - Vec3d{0, 0, kDeep}, turn({0.01, 0.02, 0.3})}, {}};
    const TickResult inside = tick_or_fail(*scene.engine, in);
    ASSERT_GT(inside.contacts.size(), 4u);
    for (const Contact& c : inside.contacts) EXPECT_EQ(c.distance_m < 0, c.point_a_m.z < 1.001);
    EXPECT_GT(inside.wrench.force_N.z, 0);
    const Pose out[2] = {{at + Vec3d{0, 0, kDeep}, turn({0.01, 0.02, 0.3})}, {}};
    const TickResult outside = tick_or_fail(*scene.engine, out);
    ASSERT_FALSE(outside.contacts.empty());
    for (const Contact& c : outside.contacts) EXPECT_GT(c.distance_m, 0);
    EXPECT_GT(outside.wrench.force_N.z, 0);
  }
}

/// A search that ends early may leave the witness on the back of a wall that is thinner than its
/// interval.
TEST(RegionsContained, what_is_before_a_thin_wall_is_not_behind_it_while_its_interval_is_open) {
  constexpr double kThinnest = 1e-7;  // to rounding both sides are one
  const Small small;
  for (const double thickness : {0.02 * kDelta, kThinnest}) {
    const BakedBody wall(box(1, 1, thickness), kRegions);
    BakedScene scene({small.body.view, wall.view}, {{0, 1}}, settings());
    const Vec3d at{0.1, 0.2, 0.1 + 0.3 * kDelta};
    const TickResult before = tick_at(scene, at);
    ASSERT_GT(before.min_distance_m, 0);
    regions::QueryMemory& memory = scene.engine->regions;
    std::uint32_t back = 0;
    while (regions::normal_of(wall.view.region_triangles[back]).z >= 0) ++back;
    for (regions::RegionPairs& kept : memory.kept) kept.near.count = 0;
    for (regions::RegionState& state : memory.states) {
      state.lower = static_cast<float>(before.min_distance_m / memory.pairs[0].unit_m) - 1e-5f;
      state.rest = state.lower;
    }
    for (regions::Witness& witness : memory.witnesses) witness.b = back;
    const Pose poses[2] = {{at, {}}, {}};
    const TickResult r = tick_or_fail(*scene.engine, poses, {.units = 1});
    ASSERT_FALSE(r.contacts.empty());
    EXPECT_GE(r.min_distance_m, before.min_distance_m - 1e-6);
    EXPECT_GT(r.wrench.force_N.z, 0);
    if (thickness == kThinnest) continue;  // nothing is inside
    tick_at(scene, {0, 0, 2});
    expect_pushed_out(tick_at(scene, at - Vec3d{0, 0, 0.3 * kDelta + 0.001}), {0, 0, 1});
  }
}

/// It may also leave it at a corner that is not the nearest place and that the point sees from
/// outside, where the mean of the faces tells nothing.
TEST(RegionsContained, corner_that_is_not_the_nearest_does_not_tell_a_side) {
  constexpr double kSize = 0.5 * kDelta;
  constexpr double kGap = 0.2 * kDelta;
  const BakedBody tool(ball(4, 6, 0.1), kRegions);
  std::mt19937 rng(3);
  int told = 0;
  for (int body = 0; body < 40; ++body) {
    const Vec3d edges[3] = {kSize * random_unit(rng), kSize * random_unit(rng),
                            kSize * random_unit(rng)};
    if (std::abs(dot(cross(edges[0], edges[1]), edges[2])) < 0.01 * kSize * kSize * kSize) continue;
    const BakedBody splinter(corner_of(edges), kRegions);
    BakedScene scene({tool.view, splinter.view}, {{0, 1}}, settings());
    regions::QueryMemory& memory = scene.engine->regions;
    for (int i = 0; i < 10; ++i) {
      const Pose poses[2] = {approach(tool.mesh, splinter.mesh, kGap, 1, random_unit(rng),
                                      turn(3.0 * random_unit(rng))),
                             {}};
      for (std::uint32_t face = 0; face < 4; ++face) {
        tick_or_fail(*scene.engine, poses);
        for (regions::RegionPairs& kept : memory.kept) kept.near.count = 0;
        for (regions::Witness& witness : memory.witnesses) witness.b = face;
        tick_or_fail(*scene.engine, poses, {.units = 1});  // measures them
        for (std::uint32_t k = 0; k < memory.states.size(); ++k) {
          memory.states[k].rest = memory.states[k].lower =
              memory.witnesses[k].distance - static_cast<float>(0.05 * memory.pairs[0].delta);
        }
        const TickResult r = tick_or_fail(*scene.engine, poses, {.units = 1});
        for (const Contact& c : r.contacts) EXPECT_GT(c.distance_m, 0) << body << ' ' << i;
        told += static_cast<int>(r.contacts.size());
      }
    }
  }
  EXPECT_GT(told, 500);
}

}  // namespace
}  // namespace palpate::test

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/pressure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "convex_shapes.hpp"

namespace palpate::convex::test {
namespace {

constexpr Vec3d kUp{0, 0, 1};

/// b in the coordinates of a, where both have a pose in the world.
struct Placed {
  Hull a, b;
  Mat3d turn_a{};
  Vec3d at_a{};

  [[nodiscard]] RelativePose pose() const {
    return {transpose(turn_a), -(transpose(turn_a) * at_a)};
  }
  [[nodiscard]] double lowest_of_a() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < a.count; ++i)
      least = std::min(least, (turn_a * (a.scale * position(a, i)) + at_a).z);
    return least;
  }
  [[nodiscard]] double top_of_b() const {
    double most = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < b.count; ++i) most = std::max(most, b.scale * position(b, i).z);
    return most;
  }
};

/// Lifts a until it is `gap` above b, and asks; all in the world, along z, from a middle off to the
/// side.
Vec3d centre(Placed& placed, double gap, double reach, Vec3d middle = {0.03, -0.02, 0}) {
  placed.at_a.z += placed.top_of_b() + gap - placed.lowest_of_a();
  static PressureScratch scratch;
  const RelativePose pose = placed.pose();
  const Mat3d to_a = transpose(placed.turn_a);
  const PressureCentre found = centre_of_pressure({placed.a, placed.b, pose}, to_a * kUp, reach,
                                                  to_a * (middle - placed.at_a), scratch);
  if (!(found.share > 0)) return middle;
  return middle + found.share * (placed.turn_a * found.at + placed.at_a - middle);
}

/// Height of the lower side (sign 1) or depth of the upper side (-1) over a place; nothing beside.
std::optional<double> height_at(const std::vector<Vec3d>& points, double x, double y, double sign) {
  std::optional<double> least;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        const Vec3d u = points[j] - points[i];
        const Vec3d v = points[k] - points[i];
        const double area = u.x * v.y - u.y * v.x;
        if (std::abs(area) < 1e-12) continue;
        const double px = x - points[i].x;
        const double py = y - points[i].y;
        const double s = (px * v.y - py * v.x) / area;
        const double t = (u.x * py - u.y * px) / area;
        if (s < 0 || t < 0 || s + t > 1) continue;
        const double height = sign * (points[i].z + s * u.z + t * v.z);
        if (!least || height < *least) least = height;
      }
    }
  }
  return least;
}

std::vector<Vec3d> in_world(const Placed& placed, bool of_a) {
  const Hull& hull = of_a ? placed.a : placed.b;
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < hull.count; ++i) {
    const Vec3d p = hull.scale * position(hull, i);
    points.push_back(of_a ? placed.turn_a * p + placed.at_a : p);
  }
  return points;
}

/// The centre by adding up over a grid; no code in common.
Vec3d added_up(const Placed& placed, double gap, double reach) {
  constexpr int kCells = 160;
  const std::vector<Vec3d> a = in_world(placed, true);
  const std::vector<Vec3d> b = in_world(placed, false);
  double low_x = -1e9, low_y = -1e9, high_x = 1e9, high_y = 1e9;
  for (const auto* points : {&a, &b}) {
    const auto [left, right] = std::minmax_element(points->begin(), points->end(),
                                                   [](Vec3d p, Vec3d q) { return p.x < q.x; });
    const auto [front, back] = std::minmax_element(points->begin(), points->end(),
                                                   [](Vec3d p, Vec3d q) { return p.y < q.y; });
    low_x = std::max(low_x, left->x);
    high_x = std::min(high_x, right->x);
    low_y = std::max(low_y, front->y);
    high_y = std::min(high_y, back->y);
  }
  double all = 0;
  Vec3d sum{};
  for (int i = 0; i < kCells; ++i) {
    for (int k = 0; k < kCells; ++k) {
      const double x = low_x + (high_x - low_x) * (i + 0.5) / kCells;
      const double y = low_y + (high_y - low_y) * (k + 0.5) / kCells;
      const auto of_a = height_at(a, x, y, 1);
      const auto of_b = height_at(b, x, y, -1);
      if (!of_a || !of_b) continue;
      const double left = reach + gap - (*of_a + *of_b);
      if (!(left > 0)) continue;
      all += left;
      sum += left * Vec3d{x, y, 0};
    }
  }
  return (1 / all) * sum;
}

double across_distance(Vec3d p, Vec3d q) { return std::hypot(p.x - q.x, p.y - q.y); }

TEST(CentreOfPressure, of_parallel_faces_is_the_middle_of_their_common_part) {
  const Shape small = box({0.1, 0.1, 0.1});
  const Shape large = box({0.5, 0.5, 0.1});
  for (const Vec3d at : {Vec3d{}, Vec3d{0.2, -0.3, 0}, Vec3d{0.5, 0, 0}, Vec3d{0.55, -0.45, 0}}) {
    Placed placed{small.hull(), large.hull(), {}, at};
    const Vec3d found = centre(placed, 0.01, 0.02, {0.41, -0.39, 0.7});
    const auto middle = [](double x) { return 0.5 * (x - 0.1 + std::min(x + 0.1, 0.5)); };
    EXPECT_NEAR(found.x, middle(at.x), 1e-7);
    EXPECT_NEAR(found.y, at.y < -0.4 ? -middle(-at.y) : at.y, 1e-7);
    EXPECT_NEAR(found.z, 0.7, 1e-12);
  }
}

TEST(CentreOfPressure, sets_a_tilted_face_back_as_its_second_moment_says) {
  const Shape small = box({0.1, 0.05, 0.1});
  const Shape large = box({0.5, 0.5, 0.1});
  constexpr double kReach = 0.02;
  for (const double tilt : {1e-4, -1e-3, 0.02, -0.05}) {
    Placed placed{small.hull(), large.hull(), rotation(about({0, 1, 0}, tilt)), {}};
    const Vec3d found = centre(placed, 0, kReach);
    // A line of springs that are pressed kReach at the low end, along what of it is pressed.
    const double slope = std::abs(std::tan(tilt));
    const double length = std::min(0.2 * std::cos(tilt), kReach / slope);
    const double pressed_end = kReach - slope * length;
    const double from_low_end = length * (kReach + 2 * pressed_end) / (3 * (kReach + pressed_end));
    const double low_end = 0.1 * std::cos(tilt) + 0.1 * std::sin(std::abs(tilt)) * -1;
    const double expected = std::copysign(low_end - from_low_end, tilt);
    EXPECT_NEAR(found.x, expected, 1e-5) << tilt;
    EXPECT_NEAR(found.y, 0, 1e-7) << tilt;
  }
}

/// A body with a bottom of many faces that rise by less than `slope`, and walls above.
Shape bowl(std::uint32_t corners, double slope, double radius, Random& random) {
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double r = i == 0 ? 0 : uniform(random, 0.3, 1);
    const double angle = uniform(random, 0, 2 * std::numbers::pi);
    points.push_back(
        {radius * r * std::cos(angle), radius * r * std::sin(angle), 0.5 * slope * radius * r * r});
  }
  for (int i = 0; i < 3; ++i)
    points.push_back(
        {uniform(random, -0.3, 0.3) * radius, uniform(random, -0.3, 0.3) * radius, 0.4});
  return convex_hull(points);
}

TEST(CentreOfPressure, is_that_of_springs_added_up_over_all_faces) {
  Random random(1);
  double largest = 0;
  for (int i = 0; i < 60; ++i) {
    const Shape a = i % 3 == 0 ? prism(3 + static_cast<std::uint32_t>(i) % 4, 0.2, 0.1)
                               : bowl(8, 0.05, 0.2, random);
    const Shape b = i % 2 == 0 ? box({0.5, uniform(random, 0.05, 0.3), 0.1}) : prism(5, 0.15, 0.2);
    const Vec3d axis = {uniform(random, -1, 1), uniform(random, -1, 1), 0};
    const Mat3d lean = rotation(about((1 / norm(axis)) * axis, uniform(random, 0, 0.03)));
    Placed placed{a.hull(),
                  b.hull(),
                  lean * rotation(about(kUp, uniform(random, 0, 2 * std::numbers::pi))),
                  {uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), 0}};
    const double gap = uniform(random, -0.002, 0.01);
    const double reach = uniform(random, 0.003, 0.02);
    const Vec3d found = centre(placed, gap, reach);
    const Vec3d expected = added_up(placed, gap, reach);
    const double off = across_distance(found, expected);
    // Walls are left out here and not there.
    EXPECT_LT(off, 0.2 * reach + 2e-4) << i;
    largest = std::max(largest, off);
  }
  RecordProperty("largest", std::to_string(largest));
}

TEST(CentreOfPressure, moves_without_leaps_as_hulls_rock_and_slide) {
  const Shape a = box({0.1, 0.1, 0.1});
  const Shape b = box({0.5, 0.5, 0.1});
  constexpr int kSteps = 4000;
  struct Path {
    Vec3d axis;
    double angle;
    Vec3d from, to;
  };
  for (const Path& path : {Path{{0, 1, 0}, 0.4, {}, {}}, Path{{0.3, 1, 0}, 0.4, {}, {}},
                           Path{{0.3, 1, 0}, 0.02, {0.3, 0.35, 0}, {0.58, 0.55, 0}}}) {
    const double turn_per_step = path.angle / kSteps;
    Vec3d before{};
    double largest = 0;
    for (int i = 0; i <= kSteps; ++i) {
      const double s = static_cast<double>(i) / kSteps;
      Placed placed{a.hull(), b.hull(),
                    rotation(about((1 / norm(path.axis)) * path.axis, path.angle * (s - 0.5))) *
                        rotation(about(kUp, 2 * s)),
                    (1 - s) * path.from + s * path.to};
      const Vec3d now = centre(placed, 0.003, 0.006);
      if (i > 0) largest = std::max(largest, across_distance(now, before));
      before = now;
    }
    // The second moment per area over the reach, as far as it turns in a step: about the axis, and
    // upright while it leans by up to half of the angle; and the slide.
    const double slide = norm(path.to - path.from) / kSteps;
    EXPECT_LT(largest, 3 * 0.04 / 12 / 0.006 * (2 * turn_per_step) + 2 * slide);
  }
}

TEST(CentreOfPressure, of_a_cylinder_moves_without_leaps_as_it_rolls_and_rocks) {
  constexpr double kReach = 0.006;
  const Shape a = prism(48, 0.08, 0.2);
  const Shape b = box({0.5, 0.5, 0.1});
  const Mat3d lying = rotation(about({0, 1, 0}, std::numbers::pi / 2));  // along x
  const auto largest_move = [&](double rocked, int steps) {
    Vec3d before{};
    double largest = 0;
    for (int i = 0; i <= steps; ++i) {
      const double s = static_cast<double>(i) / steps;
      const Mat3d rolled = rotation(about({1, 0, 0}, s)) * lying;
      Placed placed{
          a.hull(), b.hull(), rotation(about({0, 1, 0}, rocked * (s - 0.5))) * rolled, {}};
      const Vec3d now = centre(placed, 0.001, kReach);
      if (i > 0) largest = std::max(largest, across_distance(now, before));
      before = now;
    }
    return largest;
  };
  EXPECT_LT(largest_move(0, 4000), 1e-4);
  EXPECT_LT(largest_move(0.1, 4000), 1e-3);
  EXPECT_LT(largest_move(0.1, 8000), 0.6 * largest_move(0.1, 4000));
}

TEST(CentreOfPressure, moves_without_leaps_where_more_faces_come_within_reach_than_are_looked_at) {
  Random random(4);
  constexpr int kSteps = 8000;
  const Shape b = box({0.5, 0.5, 0.1});
  for (int k = 0; k < 4; ++k) {
    const Shape a = bowl(28, 0.1, 0.3, random);
    ASSERT_LE(a.vertices.size(), kMostCarrying);
    const auto largest_move = [&](int steps) {
      Vec3d before{};
      double largest = 0;
      for (int i = 0; i <= steps; ++i) {
        const double lean = 0.1 * i / steps - 0.05;
        Placed placed{a.hull(), b.hull(), rotation(about({0.6, 0.8, 0}, lean)), {}};
        const Vec3d now = centre(placed, 0.001, 0.004);
        if (i > 0) largest = std::max(largest, across_distance(now, before));
        before = now;
      }
      return largest;
    };
    // Half the steps, half the way.
    EXPECT_LT(largest_move(kSteps), 0.7 * largest_move(kSteps / 2)) << k;
    EXPECT_LT(largest_move(kSteps), 1e-3) << k;
  }
}

TEST(CentreOfPressure, does_not_depend_on_which_hull_is_a) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Shape a = any_shape(kMostCarrying, random);
    const Shape b = any_shape(kMostCarrying, random);
    const Hull of_a = a.hull(uniform(random, 0.2, 1));
    const Hull of_b = b.hull(uniform(random, 0.2, 1));
    const RelativePose pose{rotation(random_rotation(random)), random_unit(random)};
    const RelativePose back{transpose(pose.rotation),
                            -(transpose(pose.rotation) * pose.translation)};
    const Vec3d normal = random_unit(random);
    const Vec3d middle = 0.5 * random_unit(random);
    const double reach = uniform(random, 0.01, 1);
    static PressureScratch scratch;
    const PressureCentre p = centre_of_pressure({of_a, of_b, pose}, normal, reach, middle, scratch);
    const PressureCentre q =
        centre_of_pressure({of_b, of_a, back}, -(back.rotation * normal), reach,
                           back.rotation * middle + back.translation, scratch);
    EXPECT_NEAR(p.share, q.share, 1e-9) << i;
    if (!(p.share > 0)) continue;
    EXPECT_NEAR(norm(pose.rotation * q.at + pose.translation - p.at), 0, 1e-6) << i;
    EXPECT_NEAR(dot(p.at - middle, normal), 0, 1e-12) << i;
  }
}

TEST(CentreOfPressure, counts_for_nothing_where_there_is_no_face_to_find_it_on) {
  Random random(3);
  const Shape plate = box({0.5, 0.5, 0.1});
  constexpr Vec3d kMiddle{0.03, -0.02, 0};
  const auto asked = [&](const Shape& a, Mat3d turn, double reach) {
    Placed placed{a.hull(), plate.hull(), turn, {}};
    return across_distance(centre(placed, 0.001, reach, kMiddle), kMiddle);
  };
  EXPECT_EQ(asked(box({0.1, 0.1, 0.1}), {}, 0), 0);
  EXPECT_EQ(asked(box({0.1, 0.1, 0.1}), {}, -1), 0);
  EXPECT_EQ(asked(box({0.1, 0.1, 0.1}), {}, std::nan("")), 0);
  EXPECT_EQ(asked(ellipsoid(kMostCarrying + 1, {0.2, 0.2, 0.2}, random), {}, 0.01), 0);
  EXPECT_EQ(
      asked(box({0.1, 0.1, 0.1}),
            rotation(about({1 / std::numbers::sqrt2, 1 / std::numbers::sqrt2, 0}, 0.8)), 0.01),
      0);
  EXPECT_EQ(asked(point({0, 0, 0}), {}, 0.01), 0);
  EXPECT_EQ(asked(triangle({0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}), {}, 0.01), 0);  // a standing sheet
}

TEST(CentreOfPressure, of_a_triangle_lying_on_a_face_is_its_own) {
  const Shape flat = triangle({0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0});
  const Shape plate = box({0.5, 0.5, 0.1});
  Placed placed{flat.hull(), plate.hull(), {}, {}};
  const Vec3d found = centre(placed, 0.001, 0.01);
  EXPECT_NEAR(found.x, 0.1, 1e-7);
  EXPECT_NEAR(found.y, 0.1, 1e-7);
}

TEST(CentreOfPressure, has_room_for_the_most_corners) {
  const Shape a = prism(kMostCarrying / 2, 0.2, 0.1);
  for (const double turn : {0.0, 0.01, 0.1}) {
    Placed placed{a.hull(), a.hull(), rotation(about(kUp, turn)), {0.05, 0, 0}};
    const Vec3d found = centre(placed, 0.001, 0.01);
    EXPECT_NEAR(found.x, 0.025, 1e-3);
    EXPECT_NEAR(found.y, 0, 1e-3);
  }
}

}  // namespace
}  // namespace palpate::convex::test

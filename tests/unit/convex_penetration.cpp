// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/penetration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "convex_shapes.hpp"

namespace palpate::convex::test {
namespace {

struct Answer {
  Distance distance;
  Penetration penetration;
};

Answer query(const Hull& a, const Hull& b, const RelativePose& pose) {
  static const auto scratch = std::make_unique<PenetrationScratch>();
  Cache cache;
  Answer answer;
  answer.distance = distance(a, b, pose, kExact, cache);
  answer.penetration = penetration(a, b, pose, cache, *scratch);
  return answer;
}

/// What the header promises of every answer.
void expect_sound(const Hull& a, const Hull& b, const RelativePose& pose, const Penetration& p) {
  const double unit = a.scale + b.scale;
  ASSERT_TRUE(std::isfinite(p.depth) && p.depth >= 0);
  ASSERT_NEAR(norm(p.normal), 1, 1e-14);
  ASSERT_LE(p.lower_bound, p.depth);
  ASSERT_GE(p.lower_bound, 0);
  ASSERT_NEAR(norm(p.point_b - p.point_a - p.depth * p.normal), 0, 1e-13 * unit);
  // Moving a by depth * normal leaves no overlap along the normal.
  ASSERT_GE(static_cast<double>(gap_along(a, b, pose, p.normal)) + p.depth, -1e-14 * unit);
  RelativePose apart = pose;
  apart.translation -= (p.depth + 1e-8 * unit) * p.normal;
  Cache cold;
  ASSERT_NE(distance(a, b, apart, kExact, cold).state, State::penetrating);
  if (p.exact) {
    ASSERT_LE(p.depth - p.lower_bound, 1e-7 * unit);
    // The witnesses lie on the supporting planes: nothing of a is deeper than point_a.
    long double deepest = std::numeric_limits<long double>::infinity();
    for (std::uint32_t i = 0; i < a.count; ++i) {
      deepest = std::min(deepest, dot(vec_cast<long double>(p.normal), real_a(a, i)));
    }
    ASSERT_NEAR(dot(p.normal, p.point_a), static_cast<double>(deepest), 2e-7 * unit);
    // And point_a is above b, not beside it.
    const Shape foot = point(p.point_b);
    Cache beside;
    ASSERT_LE(distance(foot.hull(), b, pose, kExact, beside).distance, 1e-6 * unit);
  }
}

std::vector<Vec3d> points_of_a(const Hull& h) {
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < h.count; ++i) {
    points.push_back(vec_cast<double>(real_a(h, i)));
  }
  return points;
}

std::vector<Vec3d> points_of_b(const Hull& h, const RelativePose& pose) {
  std::vector<Vec3d> points = points_of_a(h);
  for (Vec3d& p : points) p = pose.rotation * p + pose.translation;
  return points;
}

std::vector<Vec3d> differences(const std::vector<Vec3d>& points) {
  std::vector<Vec3d> d;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) d.push_back(points[i] - points[k]);
  }
  return d;
}

double overlap_along(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b, Vec3d normal) {
  double lowest_a = std::numeric_limits<double>::infinity();
  double highest_b = -std::numeric_limits<double>::infinity();
  for (const Vec3d& p : a) lowest_a = std::min(lowest_a, dot(p, normal));
  for (const Vec3d& p : b) highest_b = std::max(highest_b, dot(p, normal));
  return highest_b - lowest_a;
}

/// Least overlap over the crosses of all pairs of vertex differences of both hulls, which hold
/// every face normal and every cross of two edges. Negative: apart.
double least_overlap(const Hull& ha, const Hull& hb, const RelativePose& pose) {
  const std::vector<Vec3d> a = points_of_a(ha);
  const std::vector<Vec3d> b = points_of_b(hb, pose);
  std::vector<Vec3d> edges = differences(a);
  const std::vector<Vec3d> more = differences(b);
  edges.insert(edges.end(), more.begin(), more.end());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3d n = cross(edges[i], edges[k]);
      const double length = norm(n);
      if (length <= 1e-6 * norm(edges[i]) * norm(edges[k])) continue;
      for (const double sign : {1 / length, -1 / length}) {
        least = std::min(least, overlap_along(a, b, sign * n));
      }
    }
  }
  return least;
}

TEST(Penetration, boxes_overlapping_by_a_face_have_the_face_depth) {
  const Shape a = box({0.5, 0.5, 0.5});
  for (const double depth : {1e-7, 1e-3, 0.1, 0.9}) {
    RelativePose pose;
    pose.translation = {0.05, 0.1, -(1 - depth)};
    const Answer r = query(a.hull(), a.hull(), pose);
    EXPECT_EQ(r.distance.state, State::penetrating);
    EXPECT_TRUE(r.penetration.exact);
    EXPECT_NEAR(r.penetration.depth, std::min(depth, 0.9), 1e-9);
    if (depth < 0.9) {
      EXPECT_NEAR(r.penetration.normal.z, 1, 1e-9);
    }
    expect_sound(a.hull(), a.hull(), pose, r.penetration);
  }
}

// From other tetrahedra the polytope grows otherwise.
TEST(Penetration, depth_does_not_depend_on_where_the_search_starts) {
  Random random(12);
  const auto scratch = std::make_unique<PenetrationScratch>();
  for (std::uint32_t compared = 0; compared < 3000;) {
    const Shape a = any_shape(24, random);
    const Shape b = any_shape(24, random);
    const RelativePose pose{rotation(random_rotation(random)),
                            uniform(random, 0.2, 1.2) * random_unit(random)};
    Cache cache;
    if (distance(a.hull(), b.hull(), pose, kExact, cache).state != State::penetrating) continue;
    const Penetration warm = penetration(a.hull(), b.hull(), pose, cache, *scratch);
    const Penetration cold = penetration(a.hull(), b.hull(), pose, {}, *scratch);
    ASSERT_NEAR(warm.depth, cold.depth, 1e-6);
    ++compared;
  }
}

TEST(Penetration, concentric_boxes_leave_through_the_nearest_face) {
  const Shape a = box({0.5, 0.4, 0.3});
  const Shape b = box({0.25, 0.25, 0.25});
  const Answer r = query(a.hull(), b.hull(), {});
  EXPECT_EQ(r.distance.state, State::penetrating);
  EXPECT_TRUE(r.penetration.exact);
  EXPECT_NEAR(r.penetration.depth, 0.55, 1e-7);
  EXPECT_NEAR(std::abs(r.penetration.normal.z), 1, 1e-9);
}

TEST(Penetration, identical_boxes_leave_by_their_width) {
  const Shape a = box({0.5, 0.4, 0.3});
  const Answer r = query(a.hull(), a.hull(), {});
  EXPECT_EQ(r.distance.state, State::penetrating);
  EXPECT_TRUE(r.penetration.exact);
  EXPECT_NEAR(r.penetration.depth, 0.6, 1e-7);
  expect_sound(a.hull(), a.hull(), {}, r.penetration);
}

TEST(Penetration, spheres_have_the_depth_of_balls) {
  Random random(1);
  const Shape a = ellipsoid(500, {0.9, 0.9, 0.9}, random);
  const Shape b = ellipsoid(500, {0.5, 0.5, 0.5}, random);
  for (const double apart : {1.35, 1.2, 1.0}) {
    RelativePose pose;
    pose.translation = apart * random_unit(random);
    const Answer r = query(a.hull(), b.hull(), pose);
    EXPECT_NEAR(r.penetration.depth, 1.4 - apart, 0.03);
    EXPECT_NEAR(norm(r.penetration.normal + (1 / apart) * pose.translation), 0, 0.15);
    expect_sound(a.hull(), b.hull(), pose, r.penetration);
  }
}

TEST(Penetration, small_hull_deep_inside_a_large_one_leaves) {
  Random random(2);
  const Shape a = ellipsoid(500, {0.9, 0.8, 0.7}, random);
  const Shape b = box({0.5, 0.5, 0.5});
  RelativePose pose;
  pose.translation = {0.1, 0.05, 0.2};
  const Answer r = query(a.hull(), b.hull(1e-4), pose);
  EXPECT_EQ(r.distance.state, State::penetrating);
  EXPECT_NEAR(r.penetration.depth, 0.5, 0.02);
  expect_sound(a.hull(), b.hull(1e-4), pose, r.penetration);
}

TEST(Penetration, triangle_through_a_box_leaves_by_the_shorter_side) {
  const Shape a = triangle({-0.9, 0, 0}, {0.9, 0, 0.1}, {0.9, 0, -0.1});
  const Shape b = box({0.2, 0.3, 0.4});
  RelativePose pose;
  pose.translation = {0, 0.2, 0};
  const Answer r = query(a.hull(), b.hull(), pose);
  EXPECT_EQ(r.distance.state, State::penetrating);
  EXPECT_NEAR(r.penetration.depth, 0.1, 2e-8);  // box from -0.1 to 0.5, triangle at 0
  EXPECT_NEAR(r.penetration.normal.y, -1, 1e-9);
  expect_sound(a.hull(), b.hull(), pose, r.penetration);
}

TEST(Penetration, crossing_triangles_match_brute_force) {
  const Shape a = triangle({-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0, 0.8, 0});
  const Shape b = triangle({0, 0, -0.3}, {0.1, 0, 0.5}, {-0.1, 0.2, 0.4});
  const Answer r = query(a.hull(), b.hull(), {});
  EXPECT_EQ(r.distance.state, State::penetrating);
  EXPECT_TRUE(r.penetration.exact);
  EXPECT_NEAR(r.penetration.depth, least_overlap(a.hull(), b.hull(), {}), 1e-9);
  expect_sound(a.hull(), b.hull(), {}, r.penetration);
}

TEST(Penetration, coplanar_triangles_have_no_depth_and_their_normal) {
  Random random(3);
  const Shape a = triangle({-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0, 0.8, 0});
  for (int i = 0; i < 100; ++i) {
    RelativePose pose{rotation(about({0, 0, 1}, uniform(random, 0, 6))), {0.1, 0.05, 0}};
    const Answer r = query(a.hull(), a.hull(), pose);
    EXPECT_EQ(r.distance.state, State::touching);
    EXPECT_TRUE(r.penetration.exact);
    EXPECT_LE(r.penetration.depth, 1e-12);
    EXPECT_NEAR(std::abs(r.penetration.normal.z), 1, 1e-9);
    EXPECT_NEAR(std::abs(r.distance.normal.z), 1, 1e-6);
    expect_sound(a.hull(), a.hull(), pose, r.penetration);
  }
}

TEST(Penetration, points_and_segments_that_meet_have_no_depth) {
  const Shape p = point({0.1, 0.2, 0.3});
  const Shape s = segment({-0.1, 0.2, 0.3}, {0.4, 0.2, 0.3});
  const Shape t = segment({0.1, -0.2, 0.3}, {0.1, 0.7, 0.3});
  const Shape* shapes[] = {&p, &s, &t};
  for (const Shape* a : shapes) {
    for (const Shape* b : shapes) {
      const Answer r = query(a->hull(), b->hull(), {});
      EXPECT_EQ(r.distance.state, State::touching);
      EXPECT_TRUE(r.penetration.exact);
      EXPECT_LE(r.penetration.depth, 1e-12);
      expect_sound(a->hull(), b->hull(), {}, r.penetration);
    }
  }
}

TEST(Penetration, point_inside_a_box_leaves_through_the_nearest_face) {
  const Shape a = point({0.1, 0.2, 0.25});
  const Shape b = box({0.5, 0.5, 0.3});
  const Answer r = query(a.hull(), b.hull(), {});
  EXPECT_EQ(r.distance.state, State::penetrating);
  EXPECT_NEAR(r.penetration.depth, 0.05, 1e-7);
  EXPECT_NEAR(r.penetration.normal.z, 1, 1e-9);
}

TEST(Penetration, random_small_hulls_match_brute_force) {
  Random random(4);
  int exact = 0;
  int overlapping = 0;
  for (int i = 0; i < 3000; ++i) {
    const Shape a =
        ellipsoid(3 + static_cast<std::uint32_t>(random() % 5), {0.9, 0.6, 0.4}, random);
    const Shape b =
        ellipsoid(3 + static_cast<std::uint32_t>(random() % 5), {0.5, 0.9, 0.3}, random);
    const RelativePose pose{rotation(random_rotation(random)), 0.3 * random_unit(random)};
    const Answer r = query(a.hull(), b.hull(), pose);
    const double least = least_overlap(a.hull(), b.hull(), pose);
    if (std::abs(least) > 1e-7) {
      ASSERT_EQ(r.distance.state == State::penetrating, least > 0);
    }
    if (r.distance.state != State::penetrating) continue;
    ++overlapping;
    expect_sound(a.hull(), b.hull(), pose, r.penetration);
    if (!r.penetration.exact) continue;
    ++exact;
    ASSERT_NEAR(r.penetration.depth, least, 2e-7);
  }
  EXPECT_GT(overlapping, 1000);
  EXPECT_EQ(exact, overlapping);
}

TEST(Penetration, any_shapes_any_overlap_sound) {
  Random random(5);
  int exact = 0;
  int overlapping = 0;
  for (int i = 0; i < 20000; ++i) {
    const Shape a = any_shape(40, random);
    const Shape b = any_shape(40, random);
    const Hull ha = a.hull();
    const Hull hb = b.hull(std::pow(10.0, uniform(random, -2, 0)));
    RelativePose pose{rotation(random_rotation(random)),
                      uniform(random, 0, 0.5) * random_unit(random)};
    // Bring a vertex of each together, then shift them a little.
    const std::vector<Vec3d> pa = points_of_a(ha);
    const std::vector<Vec3d> pb = points_of_b(hb, pose);
    pose.translation += pa[random() % pa.size()] - pb[random() % pb.size()];
    pose.translation += std::pow(10.0, uniform(random, -12, 0)) * random_unit(random);
    const Answer r = query(ha, hb, pose);
    if (r.distance.state != State::penetrating && r.distance.state != State::touching) continue;
    ++overlapping;
    exact += r.penetration.exact ? 1 : 0;
    expect_sound(ha, hb, pose, r.penetration);
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(overlapping, 2000);
  EXPECT_GT(exact, overlapping - overlapping / 100);
}

}  // namespace
}  // namespace palpate::convex::test

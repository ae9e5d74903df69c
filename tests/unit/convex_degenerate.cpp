// SPDX-License-Identifier: Apache-2.0
// distance() on the shapes that break convex queries elsewhere: flat, straight, single, needles,
// parallel faces, far away, tiny, identical; and support().
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "convex_shapes.hpp"
#include "rt_core/convex/support.hpp"

namespace palpate::convex::test {
namespace {

RelativePose at(Vec3d translation) {
  RelativePose pose;
  pose.translation = translation;
  return pose;
}

/// A cold query whose answer is proved; its distance is the expected one.
Distance expect_distance(const Hull& a, const Hull& b, const RelativePose& pose, double expected) {
  Cache cache;
  const Distance d = distance(a, b, pose, kExact, cache);
  const char* wrong = refute(a, b, pose, d, cache);
  EXPECT_EQ(wrong, nullptr) << (wrong == nullptr ? "" : wrong);
  EXPECT_NEAR(d.distance, expected, 1e-9 * (a.scale + b.scale));
  Cache again = cache;
  const Distance warm = distance(a, b, pose, kExact, again);
  EXPECT_NEAR(warm.distance, d.distance, 1e-9 * (a.scale + b.scale));
  if (d.state == State::separated) {
    EXPECT_EQ(warm.iterations, 1u);
  }
  return d;
}

TEST(Distance, two_points) {
  const Shape p = point({0.5, 0, 0});
  const Distance d = expect_distance(p.hull(), p.hull(), at({0, 3, 4}), 5);
  EXPECT_EQ(d.state, State::separated);
  EXPECT_NEAR(d.normal.y, -0.6, 1e-15);
  EXPECT_NEAR(d.normal.z, -0.8, 1e-15);
  EXPECT_EQ(d.count_a, 1u);
  EXPECT_EQ(d.count_b, 1u);
}

TEST(Distance, one_point_on_itself_touches_with_a_unit_normal) {
  const Shape p = point({0.5, 0.25, 0.125});
  const Distance d = expect_distance(p.hull(), p.hull(), {}, 0);
  EXPECT_EQ(d.state, State::touching);
  EXPECT_NEAR(norm(d.normal), 1, 1e-15);
}

TEST(Distance, boxes_face_to_face_have_the_gap) {
  const Shape a = box({0.5, 0.5, 0.5});
  for (const double gap : {1e-8, 1e-4, 0.1, 10.0, 2000.0}) {
    const Distance d = expect_distance(a.hull(), a.hull(), at({0.1, 0.2, 1 + gap}), gap);
    EXPECT_EQ(d.state, State::separated);
    EXPECT_NEAR(d.normal.z, -1, 1e-9);
  }
}

TEST(Distance, boxes_that_touch_in_a_face_an_edge_and_a_corner) {
  const Shape a = box({0.5, 0.5, 0.5});
  const Distance face = expect_distance(a.hull(), a.hull(), at({0.1, 0.2, 1}), 0);
  EXPECT_EQ(face.state, State::touching);
  EXPECT_NEAR(face.normal.z, -1, 1e-6);
  EXPECT_EQ(expect_distance(a.hull(), a.hull(), at({0.1, 1, 1}), 0).state, State::touching);
  EXPECT_EQ(expect_distance(a.hull(), a.hull(), at({1, 1, 1}), 0).state, State::touching);
}

TEST(Distance, boxes_edge_to_edge_and_corner_to_face) {
  const Shape a = box({0.5, 0.5, 0.5});
  const double r = std::sqrt(0.5);
  const Mat3d about_x = rotation(about({1, 0, 0}, std::atan(1.0)));
  const Mat3d about_y = rotation(about({0, 1, 0}, std::atan(1.0)));
  // Both stand on an edge, the edges cross.
  RelativePose pose{transpose(about_x) * about_y, transpose(about_x) * Vec3d{0, 0, 2 * r + 0.25}};
  EXPECT_EQ(expect_distance(a.hull(), a.hull(), pose, 0.25).state, State::separated);
  // A corner of b over a face of a.
  const Mat3d on_corner = rotation(about({1, -1, 0}, std::acos(1 / std::sqrt(3.0))));
  pose = {on_corner, {0.1, 0, 0.5 + std::sqrt(0.75) + 0.25}};
  const Distance d = expect_distance(a.hull(), a.hull(), pose, 0.25);
  EXPECT_EQ(d.count_b, 1u);
}

TEST(Distance, parallel_squares_and_identical_flat_hulls) {
  const Shape s = cloud({{0.5, 0.5, 0}, {-0.5, 0.5, 0}, {-0.5, -0.5, 0}, {0.5, -0.5, 0}});
  EXPECT_EQ(expect_distance(s.hull(), s.hull(), at({0, 0, 1e-3}), 1e-3).state, State::separated);
  EXPECT_EQ(expect_distance(s.hull(), s.hull(), at({0.3, 0, 0}), 0).state, State::touching);
  EXPECT_EQ(expect_distance(s.hull(), s.hull(), {}, 0).state, State::touching);
  EXPECT_EQ(expect_distance(s.hull(), s.hull(), at({1.5, 0, 0}), 0.5).state, State::separated);
}

TEST(Distance, origin_on_a_face_of_the_simplex_is_found_inside) {
  const Shape a = box({0.5, 0.5, 0.5});
  for (const Vec3d shift : {Vec3d{0, 0, 0}, Vec3d{0.25, 0, 0}, Vec3d{0.5, 0.5, 0}}) {
    EXPECT_EQ(expect_distance(a.hull(), a.hull(), at(shift), 0).state, State::penetrating);
  }
  Random random(1);
  const Shape round = ellipsoid(200, {0.9, 0.9, 0.9}, random);
  EXPECT_EQ(expect_distance(round.hull(), round.hull(), {}, 0).state, State::penetrating);
}

TEST(Distance, triangle_in_the_plane_of_another) {
  const Shape a = triangle({0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0});
  EXPECT_EQ(expect_distance(a.hull(), a.hull(), at({0.75, 0, 0}), 0.25).state, State::separated);
  EXPECT_EQ(expect_distance(a.hull(), a.hull(), at({0.1, 0.1, 0}), 0).state, State::touching);
}

TEST(Distance, needles_of_aspect_a_million) {
  const Shape a = box({0.5, 5e-7, 5e-7});
  EXPECT_EQ(expect_distance(a.hull(), a.hull(), at({0, 1e-3, 0}), 1e-3 - 1e-6).state,
            State::separated);
  const RelativePose crossed{rotation(about({0, 0, 1}, 1.0)), {0, 0, 1e-3}};
  EXPECT_EQ(expect_distance(a.hull(), a.hull(), crossed, 1e-3 - 1e-6).state, State::separated);
  EXPECT_EQ(expect_distance(a.hull(), a.hull(), at({1.5, 0, 0}), 0.5).state, State::separated);
  const RelativePose askew{rotation(about({0, 0, 1}, 1e-6)), {0, 2e-6, 0}};
  Cache cache;
  const Distance d = distance(a.hull(), a.hull(), askew, kExact, cache);
  EXPECT_EQ(refute(a.hull(), a.hull(), askew, d, cache), nullptr);
}

TEST(Distance, scales_apart_by_ten_thousand) {
  const Shape a = box({0.5, 0.5, 0.5});
  EXPECT_EQ(expect_distance(a.hull(), a.hull(1e-4), at({0.2, 0.1, 0.501}), 0.001 - 5e-5).state,
            State::separated);
  EXPECT_EQ(expect_distance(a.hull(1e-4), a.hull(), at({0, 0, 0.501}), 0.001 - 5e-5).state,
            State::separated);
}

TEST(Distance, the_unit_of_length_does_not_matter) {
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Shape a = any_shape(40, random);
    const Shape b = any_shape(40, random);
    const RelativePose pose{rotation(random_rotation(random)), 1.5 * random_unit(random)};
    Cache cache;
    const Distance d = distance(a.hull(), b.hull(), pose, kExact, cache);
    for (const double unit : {0x1p-40, 0x1p-20, 0x1p20, 0x1p40}) {  // exact in binary
      const RelativePose scaled{pose.rotation, unit * pose.translation};
      Cache cold;
      const Distance s = distance(a.hull(unit), b.hull(unit), scaled, kExact, cold);
      ASSERT_EQ(s.state, d.state);
      ASSERT_EQ(s.distance, unit * d.distance);
    }
  }
}

TEST(Distance, cache_of_one_repeated_pair_is_harmless) {
  const Shape a = box({0.5, 0.5, 0.5});
  Cache cache{4, {3, 3, 3, 3}, {2, 2, 2, 2}};
  const Distance d = distance(a.hull(), a.hull(), at({0, 0, 1.25}), kExact, cache);
  EXPECT_NEAR(d.distance, 0.25, 1e-15);
}

TEST(Distance, guess_that_parts_the_hulls_needs_one_support_pair) {
  const Shape a = box({0.5, 0.5, 0.5});
  Cache cache;
  const Distance d =
      distance(a.hull(), a.hull(), at({2, 0, 0}), {.above = 0.8}, cache, {-2, -0.2, -0.02});
  EXPECT_EQ(d.state, State::separated);
  EXPECT_EQ(d.iterations, 1u);
  EXPECT_GT(d.lower_bound, 0.8);
  EXPECT_LE(d.lower_bound, 1);
  EXPECT_NEAR(norm(d.normal), 1, 1e-15);
  EXPECT_EQ(d.distance, norm(d.point_a - d.point_b));
  EXPECT_EQ(cache.count, 1u);
  EXPECT_EQ(cache.a[0], 7u);
  EXPECT_EQ(cache.b[0], 0u);
}

TEST(Distance, infinite_or_undefined_pose_ends_without_a_claim) {
  const Shape a = box({0.5, 0.5, 0.5});
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Cache cache;
    const Distance d = distance(a.hull(), a.hull(), at({bad, 0, 0}), kExact, cache);
    EXPECT_EQ(d.state, State::gave_up);
    for (std::uint32_t i = 0; i < cache.count; ++i) EXPECT_LT(cache.a[i], 8u);
  }
}

TEST(Support, climbing_finds_what_scanning_finds) {
  Random random(3);
  const Shape shapes[] = {ellipsoid(500, {0.9, 0.9, 0.9}, random),
                          ellipsoid(300, {0.9, 0.3, 0.01}, random), cap(300, 0.02, random),
                          prism(64, 0.5, 0.4), prism(100, 0.3, 1e-5)};
  for (const Shape& s : shapes) {
    const Hull climbed = s.hull();
    ASSERT_NE(climbed.starts, nullptr);
    Hull scanned = climbed;
    scanned.starts = nullptr;
    for (int i = 0; i < 4000; ++i) {
      Vec3d d = random_unit(random);
      if ((i & 3) == 0) d = i % 8 == 0 ? Vec3d{0, 0, 1} : Vec3d{d.x, d.y, 0};  // plateaus
      const auto start = static_cast<std::uint32_t>(random() % climbed.count);
      const double found = dot(d, position(climbed, support(climbed, d, start)));
      const double truth = dot(d, position(scanned, support(scanned, d, start)));
      ASSERT_NEAR(found, truth, 1e-15);
    }
  }
}

TEST(Support, ties_go_to_the_lower_index) {
  const Shape a = box({0.5, 0.5, 0.5});
  EXPECT_EQ(support(a.hull(), {0, 0, 1}, 7), 4u);
  EXPECT_EQ(support(a.hull(), {0, 0, 0}, 7), 0u);
}

/// Whatever the scan does at once, it answers as one comparison after the other would, ties too.
TEST(Support, scan_of_any_size_finds_the_first_of_the_farthest) {
  Random random(8);
  for (std::uint32_t count = 1; count <= 100; ++count) {
    std::vector<Vec3d> points;
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool repeated = i > 0 && random() % 3 == 0;
      points.push_back(repeated ? points[random() % i] : 0.9 * random_unit(random));
    }
    const Shape shape = cloud(points);
    const Hull hull = shape.hull();
    for (int k = 0; k < 50; ++k) {
      const Vec3d d = std::pow(10.0, uniform(random, -60, 60)) * random_unit(random);
      std::uint32_t first = 0;
      for (std::uint32_t i = 1; i < count; ++i) {
        if (dot(d, position(hull, i)) > dot(d, position(hull, first))) first = i;
      }
      const Farthest found = farthest(hull, d.x, d.y, d.z, 0);
      ASSERT_EQ(found.vertex, first);
      ASSERT_EQ(found.dot, dot(d, position(hull, first)));
    }
  }
}

/// The same bits on every target, compiler and optimisation level (this file and rt_core are
/// compiled without contraction; only square roots and the four operations are used).
TEST(Distance, answers_have_golden_bits) {
  Random random(4);
  std::uint64_t hash = 14695981039346656037u;
  const auto mix = [&hash](const auto& value) {
    unsigned char bytes[sizeof(value)];
    std::memcpy(bytes, &value, sizeof(value));
    for (const unsigned char c : bytes) hash = (hash ^ c) * 1099511628211u;
  };
  const auto vector = [&random] {
    const double x = uniform(random, -1, 1);
    const double y = uniform(random, -1, 1);
    return Vec3d{x, y, uniform(random, -1, 1)};
  };
  for (int i = 0; i < 5000; ++i) {
    std::vector<Vec3d> points[2];
    for (std::vector<Vec3d>& p : points) {
      const auto count = 1 + random() % 12;
      for (std::uint64_t k = 0; k < count; ++k) p.push_back(0.5 * vector());
    }
    const Shape a = cloud(points[0]);
    const Shape b = cloud(points[1]);
    const Vec3d v = vector();
    const double length = norm(v);
    const RelativePose pose{rotation(Quat{v.x / length, v.y / length, v.z / length, 0}), vector()};
    Cache cache;
    const Distance d = distance(a.hull(), b.hull(), pose, kExact, cache);
    mix(d.distance);
    mix(d.lower_bound);
    mix(d.point_a);
    mix(d.normal);
    mix(cache.a);
  }
  EXPECT_EQ(hash, 15864401090744879493u);
}

}  // namespace
}  // namespace palpate::convex::test

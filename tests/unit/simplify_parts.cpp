// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "decompose_shapes.hpp"
#include "host_bake/simplify/box_tree.hpp"
#include "host_bake/simplify/filtered_collapse.hpp"
#include "host_bake/simplify/quadric.hpp"
#include "host_bake/simplify/relax.hpp"
#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {
namespace {

using namespace test;

struct Fan {
  Vec3d centre;
  std::vector<Vec3d> ring, far;
  std::vector<char> has_far;
};

/// A ring of n about the origin with its far vertices, noisy in the plane z = 0.
Fan flat_fan(std::size_t n, std::mt19937& random) {
  std::uniform_real_distribution<double> noise(-0.2, 0.2);
  Fan fan{{noise(random), noise(random), 0}, {}, {}, std::vector<char>(n, 1)};
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = 2 * 3.14159265358979 / static_cast<double>(n);
    const double a = turn * static_cast<double>(i);
    fan.ring.push_back({std::cos(a) + noise(random), std::sin(a) + noise(random), 0});
    fan.far.push_back({2 * std::cos(a + turn / 2), 2 * std::sin(a + turn / 2), 0});
  }
  return fan;
}

TEST(Relaxed, reproduces_linear_fields_on_a_plane) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    Fan fan = flat_fan(3 + static_cast<std::size_t>(round % 7), random);
    const Vec3d was = fan.centre;
    const Vec3d now = relaxed(fan.centre, fan.ring, fan.far, fan.has_far);
    EXPECT_LT(norm(now - was), 1e-12);
    // The same plane, tilted and moved.
    const auto tilt = [](Vec3d p) { return Vec3d{p.x + 3, 0.6 * p.y, 0.8 * p.y + 0.1}; };
    for (Vec3d& p : fan.ring) p = tilt(p);
    for (Vec3d& p : fan.far) p = tilt(p);
    EXPECT_LT(norm(relaxed(tilt(was), fan.ring, fan.far, fan.has_far) - tilt(was)), 1e-12);
  }
}

TEST(Relaxed, takes_a_spike_to_the_plane) {
  std::mt19937 random(2);
  Fan fan = flat_fan(6, random);
  fan.centre.z = 0.7;
  EXPECT_NEAR(relaxed(fan.centre, fan.ring, fan.far, fan.has_far).z, 0, 1e-12);
}

TEST(Relaxed, flaps_without_area_do_not_count) {
  std::mt19937 random(3);
  Fan fan = flat_fan(5, random);
  fan.far[2] = 0.5 * (fan.ring[2] + fan.ring[3]);
  EXPECT_LT(norm(relaxed(fan.centre, fan.ring, fan.far, fan.has_far) - fan.centre), 1e-12);
  const std::vector<Vec3d> point(4, Vec3d{1, 2, 3});
  const Vec3d stays = relaxed({1, 2, 3}, point, point, std::vector<char>(4, 1));
  EXPECT_EQ(norm(stays - Vec3d{1, 2, 3}), 0);
}

double volume(Vec3d a, Vec3d b, Vec3d c, Vec3d d) { return dot(cross(b - a, c - a), d - a); }

/// Eq. 2 at u, straight from its definition over all edges around the new vertex.
bool convex_at(const RingShape& shape, const FilterLine& line, double u) {
  const Vec3d v = line.at(u);
  const std::size_t n = shape.ring.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d a = shape.ring[i], b = shape.ring[(i + 1) % n], c = shape.ring[(i + n - 1) % n];
    if (volume(v, c, a, b) > 0) return false;
    if (volume(v, a, b, shape.far[i]) > 0) return false;
  }
  return true;
}

TEST(Feasible_part, agrees_with_sampling_eq_2) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> noise(-0.35, 0.35);
  int partial = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::size_t n = 4;
    Fan fan = flat_fan(n, random);
    Ring ring;
    ring.closed = true;
    for (std::size_t i = 0; i < n; ++i) {
      const auto h = static_cast<std::uint32_t>(3 * i);
      ring.spokes.push_back(h);
      ring.far.push_back(h);
      ring.vertices.push_back(h);
      fan.far[i].z = -1 + noise(random);
    }
    const RingShape shape{fan.ring, fan.far, fan.has_far};
    const FilterLine line{{noise(random), noise(random), 0.2 + noise(random)},
                          {noise(random), noise(random), 0.2 + noise(random)}};
    const std::vector<std::uint32_t> one_patch(3 * n, 0);
    const Feasible part = feasible_part(ring, shape, line, one_patch);
    for (int k = 0; k <= 200; ++k) {
      const double u = k / 200.0;
      if (std::abs(u - part.low) < 1e-9 || std::abs(u - part.high) < 1e-9) continue;
      const bool inside = !part.empty() && part.low < u && u < part.high;
      EXPECT_EQ(inside, convex_at(shape, line, u)) << round << " " << u;
    }
    if (!part.empty() && part.low > 0 && part.low < 1) ++partial;
  }
  EXPECT_GT(partial, 20);
}

TEST(Least_error_point, meets_three_planes_and_stays_near_the_middle_on_fewer) {
  Quadric q = plane_quadric({1, 0, 0}, {0.5, 0, 0}, 1);
  q += plane_quadric({0, 1, 0}, {0, 0.25, 0}, 2);
  Vec3d p;
  ASSERT_TRUE(least_error_point(q, {0, 0, 3}, p));
  EXPECT_LT(norm(p - Vec3d{0.5, 0.25, 3}), 1e-5);
  q += plane_quadric({0, 0, 1}, {0, 0, -1}, 1);
  ASSERT_TRUE(least_error_point(q, {0, 0, 3}, p));
  EXPECT_LT(norm(p - Vec3d{0.5, 0.25, -1}), 1e-5);
  EXPECT_FALSE(least_error_point({}, {}, p));
}

TEST(Surface, refuses_what_would_change_the_topology) {
  // A tetrahedron can lose nothing.
  NormalMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                         {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}},
                         {},
                         1};
  const Surface solid(tetrahedron);
  Ring ring;
  for (std::uint32_t h = 0; h < 12; ++h) EXPECT_FALSE(solid.find_ring(h, ring));
  // Two triangles in a strip: each hangs on the common edge alone.
  const Surface strip(
      NormalMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {2, 1, 3}}, {}, 1});
  for (std::uint32_t h = 0; h < 6; ++h)
    if (strip.twin[h] != kNothing) {
      EXPECT_FALSE(strip.find_ring(h, ring));
    }
}

TEST(Surface, rings_of_a_sphere_are_closed_and_of_a_rim_open) {
  const Surface closed(as_is(sphere(4)));
  Ring ring;
  for (std::uint32_t h = 0; h < closed.twin.size(); ++h) {
    ASSERT_TRUE(closed.find_ring(h, ring));
    EXPECT_TRUE(ring.closed);
    EXPECT_EQ(ring.vertices.size(), ring.spokes.size());
  }
  const Surface open(as_is(open_hemisphere(4)));
  for (std::uint32_t h = 0; h < open.twin.size(); ++h) {
    if (open.twin[h] != kNothing || !open.find_ring(h, ring)) continue;
    EXPECT_FALSE(ring.closed);
    EXPECT_EQ(ring.vertices.size(), ring.spokes.size() + 1);
  }
}

TEST(Box_tree, finds_what_brute_force_finds) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(-1, 1);
  std::uniform_real_distribution<float> exponent(-18, 1);
  const auto random_box = [&] {
    FaceBox box;
    for (std::size_t i = 0; i < 3; ++i) {
      box.low[i] = place(random);
      box.high[i] = box.low[i] + std::exp2(exponent(random));
    }
    return box;
  };
  constexpr std::uint32_t kBoxes = 300;
  BoxTree grid(kBoxes);
  std::vector<FaceBox> boxes(kBoxes);
  std::vector<char> in(kBoxes, 0);
  for (int round = 0; round < 3000; ++round) {
    const auto id = static_cast<std::uint32_t>(random() % kBoxes);
    if (random() % 4 == 0) {
      grid.take(id);
      in[id] = 0;
    } else {
      boxes[id] = random_box();
      grid.put(id, boxes[id]);
      in[id] = 1;
    }
    const FaceBox query = random_box();
    std::vector<std::uint32_t> found, expected;
    grid.search(query, [&](std::uint32_t b) {
      found.push_back(b);
      return false;
    });
    std::sort(found.begin(), found.end());
    for (std::uint32_t b = 0; b < kBoxes; ++b)
      if (in[b] && boxes[b].meets(query)) expected.push_back(b);
    ASSERT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace palpate::bake

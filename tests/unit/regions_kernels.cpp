// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "tests/support/triangle_distance.hpp"

namespace palpate::regions {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec3d in_cube(Random& random, double half) {
  return {uniform(random, -half, half), uniform(random, -half, half), uniform(random, -half, half)};
}

Mat3d random_rotation(Random& random) {
  Quat q{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1),
         uniform(random, -1, 1)};
  const double n = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return rotation(Quat{q.w / n, q.x / n, q.y / n, q.z / n});
}

Transform in_float(const Mat3d& r, Vec3d t, double scale) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {{f(r.row0.x), f(r.row0.y), f(r.row0.z), f(r.row1.x), f(r.row1.y), f(r.row1.z),
           f(r.row2.x), f(r.row2.y), f(r.row2.z)},
          {f(t.x), f(t.y), f(t.z)},
          f(scale)};
}

/// The map that the floats stand for, in double.
Vec3d mapped(const Transform& m, Vec3d p) {
  const auto row = [&](int i) {
    return Vec3d{double(m.rotation[3 * i]), double(m.rotation[3 * i + 1]),
                 double(m.rotation[3 * i + 2])};
  };
  const Vec3d s = double(m.scale) * p;
  return {dot(row(0), s) + double(m.translation[0]), dot(row(1), s) + double(m.translation[1]),
          dot(row(2), s) + double(m.translation[2])};
}

void put(Vec3d p, int corner, image::RegionTriangle& out) {
  out.corners[3 * corner] = static_cast<float>(p.x);
  out.corners[3 * corner + 1] = static_cast<float>(p.y);
  out.corners[3 * corner + 2] = static_cast<float>(p.z);
}

/// Triangles of all kinds: fat ones, needles, caps, segments and points.
image::RegionTriangle random_triangle(Random& random, double size) {
  Vec3d p[3] = {in_cube(random, 0.5), {}, {}};
  p[1] = p[0] + in_cube(random, size);
  p[2] = p[0] + in_cube(random, size);
  switch (random() % 8) {
    case 0:
      p[2] = p[1] + in_cube(random, 1e-4 * size);
      break;
    case 1:
      p[2] = 0.5 * (p[0] + p[1]) + in_cube(random, 1e-4 * size);
      break;
    case 2:
      p[2] = 0.3 * p[0] + 0.7 * p[1];
      break;
    case 3:
      p[2] = p[1];
      break;
    case 4:
      p[1] = p[2] = p[0];
      break;
    default:
      break;
  }
  image::RegionTriangle t{};
  for (int i = 0; i < 3; ++i) put(p[i], i, t);
  return t;
}

Vec3d corner(const image::RegionTriangle& t, int i) {
  return {double(t.corners[3 * i]), double(t.corners[3 * i + 1]), double(t.corners[3 * i + 2])};
}

struct Pairs {
  image::RegionTriangle a[kBatch], b[kBatch];
  const image::RegionTriangle *at_a[kBatch], *at_b[kBatch];
  Transform map;
};

Pairs random_pairs(Random& random) {
  Pairs pairs;
  const double size = std::pow(10.0, uniform(random, -3.0, 0.0));
  pairs.map = in_float(random_rotation(random), in_cube(random, 0.05 + size),
                       std::pow(10.0, uniform(random, -1.0, 1.0)));
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    pairs.a[i] = random_triangle(random, size);
    pairs.b[i] = random_triangle(random, size);
    // Most pairs of one size are far apart; these meet.
    const Vec3d to = mapped(pairs.map, corner(pairs.a[i], 0));
    const Vec3d by = to - corner(pairs.b[i], 0) + in_cube(random, size);
    for (int c = 0; c < 3; ++c) {
      pairs.b[i].corners[3 * c] += static_cast<float>(by.x);
      pairs.b[i].corners[3 * c + 1] += static_cast<float>(by.y);
      pairs.b[i].corners[3 * c + 2] += static_cast<float>(by.z);
    }
    pairs.at_a[i] = &pairs.a[i];
    pairs.at_b[i] = &pairs.b[i];
  }
  return pairs;
}

test::TriangleDistance truth(const Pairs& pairs, std::uint32_t i) {
  Vec3d a[3], b[3];
  for (int c = 0; c < 3; ++c) {
    a[c] = mapped(pairs.map, corner(pairs.a[i], c));
    b[c] = corner(pairs.b[i], c);
  }
  return test::triangle_distance(a, b);
}

std::span<const Kernels* const> tables() {
  static const Kernels* found[kMostKernels];
  static const std::uint32_t count = all_kernels(found);
  return {found, count};
}

TEST(RegionKernels, TriangleDistance_of_all_kinds_of_triangles_is_right_to_a_millionth) {
  Random random(1);
  const auto scratch = std::make_unique<KernelScratch>();
  for (int round = 0; round < 4000; ++round) {
    const Pairs pairs = random_pairs(random);
    float squared[kBatch];
    const std::uint32_t crossing =
        best_kernels().triangle_distances(pairs.at_a, pairs.at_b, pairs.map, *scratch, squared);
    const double size = 1 + 10 * double(pairs.map.scale);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const double exact = truth(pairs, i).distance;
      ASSERT_NEAR(std::sqrt(double(squared[i])), exact, 1e-6 * size) << round << " " << i;
      if ((crossing >> i & 1) != 0) {
        ASSERT_EQ(squared[i], 0.0f);
      }
    }
  }
}

TEST(RegionKernels, TriangleWays_are_as_long_as_the_distances) {
  Random random(7);
  const auto scratch = std::make_unique<KernelScratch>();
  for (int round = 0; round < 1000; ++round) {
    const Pairs pairs = random_pairs(random);
    const Kernels& kernels = best_kernels();
    float squared[kBatch], again[kBatch], apart[3][kBatch];
    const std::uint32_t crossing =
        kernels.triangle_distances(pairs.at_a, pairs.at_b, pairs.map, *scratch, squared);
    ASSERT_EQ(crossing,
              kernels.triangle_ways(pairs.at_a, pairs.at_b, pairs.map, *scratch, again, apart));
    ASSERT_EQ(std::memcmp(squared, again, sizeof squared), 0);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      if ((crossing >> i & 1) != 0) continue;
      const Vec3d way{double(apart[0][i]), double(apart[1][i]), double(apart[2][i])};
      ASSERT_NEAR(norm(way), std::sqrt(double(squared[i])), 1e-6 * (1 + norm(way)));
    }
  }
}

/// Along a direction, over all corners in double.
double separation(const Pairs& pairs, std::uint32_t i, Vec3d along) {
  double least_a = std::numeric_limits<double>::infinity(), most_b = -least_a;
  for (int c = 0; c < 3; ++c) {
    least_a = std::min(least_a, dot(along, mapped(pairs.map, corner(pairs.a[i], c))));
    most_b = std::max(most_b, dot(along, corner(pairs.b[i], c)));
  }
  return least_a - most_b;
}

TEST(RegionKernels, Separations_bound_distances_and_mostly_meet_them_along_their_ways) {
  Random random(8);
  const auto scratch = std::make_unique<KernelScratch>();
  int met = 0, asked = 0;
  for (int round = 0; round < 1000; ++round) {
    const Pairs pairs = random_pairs(random);
    const Kernels& kernels = best_kernels();
    const double size = 1 + 10 * double(pairs.map.scale);
    float squared[kBatch], apart[3][kBatch], separations[kBatch];
    const std::uint32_t crossing =
        kernels.triangle_ways(pairs.at_a, pairs.at_b, pairs.map, *scratch, squared, apart);
    const std::uint32_t lane = static_cast<std::uint32_t>(round) % kBatch;
    const Vec3d way{double(apart[0][lane]), double(apart[1][lane]), double(apart[2][lane])};
    if ((crossing >> lane & 1) != 0 || !(norm(way) > 1e-3 * size)) continue;
    const Vec3d along = (1 / norm(way)) * way;
    kernels.separations(pairs.at_a, pairs.at_b, pairs.map, vec_cast<float>(along), separations);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      ASSERT_NEAR(double(separations[i]), separation(pairs, i, along), 1e-6 * size);
      ASSERT_LE(double(separations[i]), std::sqrt(double(squared[i])) + 1e-6 * size);
    }
    // A needle's closest point may be off where its distance is not: then less is proved.
    met += double(separations[lane]) > norm(way) - 2e-6 * size ? 1 : 0;
    ++asked;
  }
  EXPECT_GT(asked, 300);
  EXPECT_GT(met, 0.95 * asked);
}

TEST(RegionKernels, TriangleCourses_bound_distances_all_along_and_are_those_where_nothing_moves) {
  Random random(10);
  const auto scratch = std::make_unique<KernelScratch>();
  int apart = 0, met = 0;
  for (int round = 0; round < 1000; ++round) {
    Pairs pairs = random_pairs(random);
    const double size = 1 + 10 * double(pairs.map.scale);
    const Vec3d course = vec_cast<double>(vec_cast<float>(in_cube(random, 0.2 * size)));
    float squared[kBatch], still[kBatch], again[kBatch], least[kBatch];
    const std::uint32_t crossing =
        best_kernels().triangle_distances(pairs.at_a, pairs.at_b, pairs.map, *scratch, squared);
    best_kernels().triangle_courses(pairs.at_a, pairs.at_b, pairs.map, {}, *scratch, again, still);
    ASSERT_EQ(crossing,
              best_kernels().triangle_courses(pairs.at_a, pairs.at_b, pairs.map,
                                              vec_cast<float>(course), *scratch, again, least));
    ASSERT_EQ(std::memcmp(squared, again, sizeof squared), 0);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const double distance = std::sqrt(double(squared[i]));
      ASSERT_LE(std::sqrt(double(still[i])), distance + 1e-6 * size);
      // A needle's closest point may be off where its distance is not: then less is proved.
      apart += distance > 1e-3 * size ? 1 : 0;
      met += distance > 1e-3 * size && std::sqrt(double(still[i])) > distance - 2e-6 * size ? 1 : 0;
    }
    const Transform start = pairs.map;
    for (const double part : {0.0, 0.2, 0.5, 1.0}) {
      const double shift[3] = {course.x, course.y, course.z};
      for (int k = 0; k < 3; ++k) {
        pairs.map.translation[k] = start.translation[k] + static_cast<float>(part * shift[k]);
      }
      for (std::uint32_t i = 0; i < kBatch; ++i) {
        ASSERT_LE(std::sqrt(double(least[i])), truth(pairs, i).distance + 1e-6 * size);
      }
    }
  }
  EXPECT_GT(apart, 5000);
  EXPECT_GT(met, 0.95 * apart);
}

/// Corners of a box that is given by axes, centre and half lengths.
std::array<Vec3d, 8> corners_of(const Vec3d (&axes)[3], Vec3d centre, const double (&half)[3]) {
  std::array<Vec3d, 8> out;
  for (std::size_t i = 0; i < 8; ++i) {
    out[i] = centre;
    for (int k = 0; k < 3; ++k) out[i] += ((i >> k & 1) != 0 ? half[k] : -half[k]) * axes[k];
  }
  return out;
}

struct Boxes {
  Box one{};
  image::RegionNode node{};
  Transform map;
  std::array<Vec3d, 8> corners_of_one;  // in the node's coordinates
  std::array<std::array<Vec3d, 8>, kBatch> corners;
};

Boxes random_boxes(Random& random) {
  Boxes boxes;
  boxes.map = in_float(random_rotation(random), in_cube(random, 1),
                       std::pow(10.0, uniform(random, -1.0, 1.0)));
  const auto draw = [&](double size, Vec3d(&axes)[3], Vec3d& centre, double(&half)[3]) {
    const Mat3d r = random_rotation(random);
    const auto f = [](Vec3d v) { return vec_cast<double>(vec_cast<float>(v)); };
    axes[0] = f(r.row0), axes[1] = f(r.row1), axes[2] = f(r.row2);
    centre = f(in_cube(random, 0.7));
    for (double& h : half) h = double(static_cast<float>(uniform(random, 0, size)));
  };
  Vec3d axes[3], centre;
  double half[3];
  draw(0.2, axes, centre, half);
  const auto put = [](Box& box, int i, Vec3d v) {
    box.x[i] = float(v.x), box.y[i] = float(v.y), box.z[i] = float(v.z);
  };
  for (int k = 0; k < 3; ++k) put(boxes.one, k, axes[k]), boxes.one.half[k] = float(half[k]);
  put(boxes.one, 3, centre);
  boxes.one.half[3] = 0;
  boxes.corners_of_one = corners_of(axes, centre, half);
  for (Vec3d& p : boxes.corners_of_one) p = mapped(boxes.map, p);
  boxes.node.children = kBatch;
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    draw(0.3, axes, centre, half);
    const double row[3] = {centre.x, centre.y, centre.z};
    for (int k = 0; k < 3; ++k) {
      boxes.node.centre[k][i] = float(row[k]);
      boxes.node.half[k][i] = float(half[k]);
      boxes.node.axes[3 * k][i] = float(axes[k].x);
      boxes.node.axes[3 * k + 1][i] = float(axes[k].y);
      boxes.node.axes[3 * k + 2][i] = float(axes[k].z);
    }
    boxes.corners[i] = corners_of(axes, centre, half);
  }
  return boxes;
}

/// Nearest of some random points of both boxes: no bound may be larger.
double nearest_points(Random& random, const std::array<Vec3d, 8>& a,
                      const std::array<Vec3d, 8>& b) {
  const auto point = [&](const std::array<Vec3d, 8>& corners) {
    Vec3d p = corners[0];
    for (int k = 0; k < 3; ++k) {
      const double t = std::clamp(uniform(random, -0.5, 1.5), 0.0, 1.0);  // often on the surface
      p += t * (corners[std::size_t{1} << k] - corners[0]);
    }
    return p;
  };
  double least = 1e9;
  for (int i = 0; i < 60; ++i) least = std::min(least, norm(point(a) - point(b)));
  return least;
}

TEST(RegionKernels, BoxBound_never_exceeds_the_distance_of_two_points_of_the_boxes) {
  Random random(3);
  int positive = 0;
  for (int round = 0; round < 1000; ++round) {
    const Boxes boxes = random_boxes(random);
    BoxTest test;
    const std::uint32_t near =
        best_kernels().test_boxes(boxes.one, boxes.map, {}, boxes.node, 1, 0.25f, Order::any, test);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const double bound = std::sqrt(double(test.squared[i]));
      ASSERT_LE(bound, nearest_points(random, boxes.corners_of_one, boxes.corners[i]) +
                           1e-6 * (1 + double(boxes.map.scale)));
      ASSERT_EQ((near >> i & 1) != 0, test.squared[i] < 0.25f);
      positive += bound > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(positive, 8000);  // else the bound would be of no use
}

TEST(RegionKernels, BoxBound_holds_all_along_a_course) {
  Random random(9);
  int positive = 0;
  for (int round = 0; round < 1000; ++round) {
    const Boxes boxes = random_boxes(random);
    const Vec3f course = vec_cast<float>(in_cube(random, 0.3));
    BoxTest at_rest, test;
    best_kernels().test_boxes(boxes.one, boxes.map, {}, boxes.node, 1, 0.25f, Order::any, at_rest);
    best_kernels().test_boxes(boxes.one, boxes.map, course, boxes.node, 1, 0.25f, Order::any, test);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const double bound = std::sqrt(double(test.squared[i]));
      const double rounding = 1e-6 * (1 + double(boxes.map.scale));
      ASSERT_LE(bound, std::sqrt(double(at_rest.squared[i])) + rounding);
      for (const double part : {0.0, 0.3, 0.6, 1.0}) {
        std::array<Vec3d, 8> moved = boxes.corners_of_one;
        for (Vec3d& p : moved) p += part * vec_cast<double>(course);
        ASSERT_LE(bound, nearest_points(random, moved, boxes.corners[i]) + rounding);
      }
      positive += bound > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(positive, 6000);
}

TEST(RegionKernels, BoxBound_of_aligned_boxes_is_their_distance) {
  Boxes boxes;
  boxes.map = in_float(Mat3d{}, Vec3d{3, 0, 0}, 1);
  boxes.one = {{1, 0, 0, 0}, {0, 1, 0, 2}, {0, 0, 1, 0}, {0.5f, 0.5f, 0.5f, 0}};
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    boxes.node.axes[0][i] = boxes.node.axes[4][i] = boxes.node.axes[8][i] = 1;
    for (auto& half : boxes.node.half) half[i] = 0.5f;
  }
  BoxTest test;
  best_kernels().test_boxes(boxes.one, boxes.map, {}, boxes.node, 1, 1, Order::any, test);
  EXPECT_EQ(test.squared[5], 2.0f * 2.0f + 1.0f);
  best_kernels().test_boxes(boxes.one, boxes.map, {}, boxes.node, 9, 1, Order::any, test);
  EXPECT_EQ(test.squared[5], 9 * (2.0f * 2.0f + 1.0f));
  // What goes along a face comes no nearer; what goes away is nearest where it starts.
  best_kernels().test_boxes(boxes.one, boxes.map, {0, 0, 4}, boxes.node, 1, 1, Order::any, test);
  EXPECT_EQ(test.squared[5], 2.0f * 2.0f + 1.0f);
  best_kernels().test_boxes(boxes.one, boxes.map, {1, 0, 0}, boxes.node, 1, 1, Order::any, test);
  EXPECT_EQ(test.squared[5], 2.0f * 2.0f + 1.0f);
  best_kernels().test_boxes(boxes.one, boxes.map, {-1, 0, 0}, boxes.node, 1, 1, Order::any, test);
  EXPECT_EQ(test.squared[5], 1.0f + 1.0f);
}

TEST(RegionKernels, Boxes_are_placed_by_how_near_they_are) {
  constexpr float kFar = std::numeric_limits<float>::max();
  Random random(5);
  int overlapping = 0;
  for (int round = 0; round < 1500; ++round) {
    Boxes boxes = random_boxes(random);
    boxes.node.children = 1 + static_cast<std::uint32_t>(round) % kBatch;
    const float below = round % 3 == 0 ? kFar : 0.25f;
    BoxTest test;
    const std::uint32_t near = best_kernels().test_boxes(boxes.one, boxes.map, {}, boxes.node, 1,
                                                         below, Order::by_distance, test);
    const Vec3d centre =
        mapped(boxes.map, {double(boxes.one.x[3]), double(boxes.one.y[3]), double(boxes.one.z[3])});
    const auto apart = [&](std::uint32_t i) {
      const auto& c = boxes.node.centre;
      return squared_norm(centre - Vec3d{double(c[0][i]), double(c[1][i]), double(c[2][i])});
    };
    std::vector<std::uint32_t> order;  // farthest first
    float least_passed = kFar;
    for (std::uint32_t i = 0; i < boxes.node.children; ++i) {
      if ((near >> i & 1) != 0)
        order.push_back(i);
      else
        least_passed = std::min(least_passed, test.squared[i]);
    }
    ASSERT_EQ(near >> boxes.node.children, 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t p, std::uint32_t q) { return test.place[p] < test.place[q]; });
    for (std::size_t k = 0; k < order.size(); ++k) {
      ASSERT_EQ(std::size_t(test.place[order[k]]), k);
      if (k == 0) continue;
      const float farther = test.squared[order[k - 1]], nearer = test.squared[order[k]];
      ASSERT_LE(nearer, farther * (1 + 3e-6f));
      if (farther == 0) {
        ASSERT_LE(apart(order[k]), apart(order[k - 1]) * (1 + 1e-5));
        ++overlapping;
      }
    }
    const float passed = *std::min_element(test.passed, test.passed + boxes.node.children);
    ASSERT_EQ(passed, least_passed);
  }
  EXPECT_GT(overlapping, 20);
}

TEST(RegionKernels, BoxTest_keeps_the_least_of_what_was_passed_over) {
  Boxes boxes;
  boxes.map = in_float(Mat3d{}, Vec3d{3, 0, 0}, 1);
  boxes.node.children = kBatch;
  BoxTest test;
  std::fill_n(test.passed, kBatch, 7.0f);
  best_kernels().test_boxes(boxes.one, boxes.map, {}, boxes.node, 1, 1, Order::any, test);
  EXPECT_EQ(test.passed[3], 7.0f);
  boxes.map = in_float(Mat3d{}, Vec3d{2, 0, 0}, 1);
  boxes.node.axes[0][3] = 1;
  best_kernels().test_boxes(boxes.one, boxes.map, {}, boxes.node, 1, 1, Order::any, test);
  EXPECT_EQ(test.passed[3], 4.0f);
  EXPECT_EQ(test.passed[2], 7.0f);
}

/// Corner c of the two triangles of a lane.
void put_corners(Vec3d a, Vec3d b, int c, std::uint32_t lane, TriangleLanes& out) {
  const double rows_a[3] = {a.x, a.y, a.z}, rows_b[3] = {b.x, b.y, b.z};
  for (int k = 0; k < 3; ++k) {
    out.a[3 * c + k][lane] = static_cast<float>(rows_a[k]);
    out.b[3 * c + k][lane] = static_cast<float>(rows_b[k]);
  }
}

/// As those who ask for witnesses do.
void put_all(const Pairs& pairs, TriangleLanes& out) {
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    const Vec3d origin = corner(pairs.b[i], 0);
    for (int c = 0; c < 3; ++c) {
      put_corners(mapped(pairs.map, corner(pairs.a[i], c)) - origin, corner(pairs.b[i], c) - origin,
                  c, i, out);
    }
  }
}

TEST(RegionKernels, Witnesses_are_as_far_apart_as_the_triangles) {
  Random random(4);
  const auto scratch = std::make_unique<KernelScratch>();
  for (int round = 0; round < 1000; ++round) {
    const Pairs pairs = random_pairs(random);
    put_all(pairs, scratch->lanes);
    WitnessLanes found;
    best_kernels().witnesses(*scratch, found);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const test::TriangleDistance exact = truth(pairs, i);
      const Vec3d apart{double(found.apart[0][i]), double(found.apart[1][i]),
                        double(found.apart[2][i])};
      if ((found.crossing >> i & 1) != 0) {
        ASSERT_LE(exact.distance, 1e-6);
      } else {
        ASSERT_NEAR(norm(apart), exact.distance, 1e-6 * (1 + 10 * double(pairs.map.scale)));
      }
    }
  }
}

/// Where the lever from the corners to the nearest point is longest.
TEST(RegionKernels, Witnesses_above_the_middle_of_a_needle_are_right_to_a_millionth) {
  constexpr double kHeight = 0.01;
  Random random(6);
  const auto scratch = std::make_unique<KernelScratch>();
  for (int round = 0; round < 1000; ++round) {
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const Mat3d turn = random_rotation(random);
      const double width = std::pow(10.0, uniform(random, -4, -2));
      const Vec3d tip{uniform(random, -0.3, 0.3), 0.1 * width, kHeight};
      const Vec3d a[3] = {tip, tip + Vec3d{0.2, 0.1, 0.3}, tip + Vec3d{-0.1, 0.2, 0.3}};
      const Vec3d b[3] = {{-0.5, 0, 0}, {0.5, 0, 0}, {-0.5, width, 0}};
      for (int c = 0; c < 3; ++c) {
        put_corners(turn * (a[c] - tip), turn * (b[c] - tip), c, i, scratch->lanes);
      }
    }
    WitnessLanes found;
    best_kernels().witnesses(*scratch, found);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const Vec3d apart{double(found.apart[0][i]), double(found.apart[1][i]),
                        double(found.apart[2][i])};
      ASSERT_NEAR(norm(apart), kHeight, 1e-6) << round;
    }
  }
}

TEST(RegionKernels, Tables_give_the_same_bits) {
  // About the pairs; some are outside, and some edges are long.
  Random random(2);
  const auto scratch = std::make_unique<KernelScratch>();
  for (int round = 0; round < 500; ++round) {
    const Pairs pairs = random_pairs(random);
    const Boxes boxes = random_boxes(random);
    put_all(pairs, scratch->lanes);
    float first[kBatch], other[kBatch], way_first[3][kBatch], way_other[3][kBatch];
    float separation_first[kBatch], separation_other[kBatch];
    float least_first[kBatch], least_other[kBatch];
    WitnessLanes found_first, found_other;
    const auto run = [&](const Kernels& table, float(&squared)[kBatch], WitnessLanes& found) {
      const std::uint32_t crossing =
          table.triangle_distances(pairs.at_a, pairs.at_b, pairs.map, *scratch, squared);
      table.witnesses(*scratch, found);
      return crossing;
    };
    const std::uint32_t crossing = run(*tables()[0], first, found_first);
    const auto run_along = [&](const Kernels& table, float(&ways)[3][kBatch],
                               float(&separations)[kBatch], float(&least)[kBatch]) {
      float squared[kBatch];
      table.triangle_ways(pairs.at_a, pairs.at_b, pairs.map, *scratch, squared, ways);
      const Vec3f along{0.6f, -0.64f, 0.48f};
      table.separations(pairs.at_a, pairs.at_b, pairs.map, along, separations);
      table.triangle_courses(pairs.at_a, pairs.at_b, pairs.map, along, *scratch, squared, least);
    };
    run_along(*tables()[0], way_first, separation_first, least_first);
    for (const Kernels* table : tables()) {
      run_along(*table, way_other, separation_other, least_other);
      ASSERT_EQ(std::memcmp(least_first, least_other, sizeof least_first), 0) << table->name;
      ASSERT_EQ(std::memcmp(way_first, way_other, sizeof way_first), 0) << table->name;
      ASSERT_EQ(std::memcmp(separation_first, separation_other, sizeof separation_first), 0)
          << table->name;
      ASSERT_EQ(crossing, run(*table, other, found_other));
      ASSERT_EQ(std::memcmp(first, other, sizeof first), 0) << table->name;
      ASSERT_EQ(std::memcmp(found_first.apart, found_other.apart, sizeof found_first.apart), 0);
      ASSERT_EQ(std::memcmp(found_first.on_a, found_other.on_a, sizeof found_first.on_a), 0);
      ASSERT_EQ(found_first.crossing, found_other.crossing);
    }
    const Vec3f course{0.1f, -0.02f, 0.05f};
    for (const Order order : {Order::any, Order::by_distance}) {
      BoxTest expected;
      const std::uint32_t near = tables()[0]->test_boxes(boxes.one, boxes.map, course, boxes.node,
                                                         1.5f, 1, order, expected);
      for (const Kernels* table : tables()) {
        BoxTest test;
        ASSERT_EQ(near, table->test_boxes(boxes.one, boxes.map, course, boxes.node, 1.5f, 1, order,
                                          test));
        ASSERT_EQ(std::memcmp(&expected, &test, sizeof test), 0) << table->name;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::regions

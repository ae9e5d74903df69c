// SPDX-License-Identifier: GPL-3.0-or-later
// The hulls that spare building hulls, against hulls built whole.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "decompose_shapes.hpp"
#include "host_bake/hull/facets.hpp"
#include "host_bake/simplify/lazy_hull.hpp"
#include "host_bake/simplify/outer_hull.hpp"
#include "host_bake/simplify/patch_bodies.hpp"
#include "hull_oracle.hpp"

namespace palpate::bake {
namespace {

using namespace test;

using Random = std::mt19937;

PointF random_point(Random& random, float reach) {
  std::uniform_real_distribution<float> coordinate(-reach, reach);
  return {coordinate(random), coordinate(random), coordinate(random)};
}

/// On a sphere, or on the faces and edges of a cube where many lie in a plane.
std::vector<PointF> convex_points(Random& random, std::size_t count, bool cube) {
  std::vector<PointF> points;
  while (points.size() < count) {
    PointF p = random_point(random, 1);
    float length = 0;
    for (const float c : p) length = cube ? std::max(length, std::abs(c)) : length + c * c;
    if (length < 0.01F) continue;
    if (!cube) length = std::sqrt(length);
    for (float& c : p) c = 0.5F * (c / length);
    if (cube)
      for (float& c : p) c = std::abs(c) > 0.4F ? std::copysign(0.5F, c) : c;
    points.push_back(p);
  }
  return points;
}

Corners random_triangle(Random& random) {
  const PointF at = random_point(random, 0.6F);
  Corners triangle;
  for (PointF& p : triangle) {
    p = random_point(random, 0.15F);
    for (std::size_t i = 0; i < 3; ++i) p[i] += at[i];
  }
  return triangle;
}

bool enters_whole(const std::vector<PointF>& points, const Corners& triangle) {
  HullBuilder builder;
  ShrunkHull hull;
  return builder.build(points, hull) == HullKind::solid && enters(hull, triangle);
}

TEST(LazyHull, answers_as_the_whole_hull_does) {
  Random random(1);
  int in = 0, out = 0;
  for (int round = 0; round < 60; ++round) {
    const auto points = convex_points(random, 100, round % 2 == 0);
    HullBuilder builder;
    ShrunkHull whole;
    ASSERT_EQ(builder.build(points, whole), HullKind::solid);
    const std::vector<std::uint32_t> near = {0, 1, 2, 3};
    LazyHull lazy;
    lazy.start(points, near);
    for (int i = 0; i < 40; ++i) {
      Corners triangle = random_triangle(random);
      if (i % 4 == 0) triangle[0] = points[static_cast<std::size_t>(i)];  // touches
      const Entry entry = lazy.entered_by(triangle);
      if (entry == Entry::unknown) continue;
      EXPECT_EQ(entry == Entry::yes, enters(whole, triangle)) << round << " " << i;
      ++(entry == Entry::yes ? in : out);
    }
  }
  EXPECT_GT(in, 300);
  EXPECT_GT(out, 300);
}

TEST(LazyHull_keepers, hold_all_points_and_keep_the_triangle_out) {
  Random random(2);
  const auto points = convex_points(random, 200, false);
  LazyHull lazy;
  const std::vector<std::uint32_t> near = {5, 6, 7};
  lazy.start(points, near);
  for (int i = 0; i < 100; ++i) {
    if (lazy.entered_by(random_triangle(random)) != Entry::no) continue;
    ASSERT_FALSE(lazy.keepers().empty());
    for (const BoundingPlane& plane : lazy.keepers())
      for (const PointF& p : points)
        EXPECT_TRUE(plane.holds(
            {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])}));
  }
}

TEST(LazyHull_of_points_in_a_plane, does_not_know) {
  const std::vector<PointF> flat = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  LazyHull lazy;
  const std::vector<std::uint32_t> near = {0, 1, 2, 3};
  lazy.start(flat, near);
  EXPECT_EQ(lazy.entered_by({PointF{0, 0, -1}, {1, 0, -1}, {1, 1, 1}}), Entry::unknown);
}

/// The upper half of a sphere as one patch, all of it.
struct Cap {
  NormalMesh mesh = as_is(open_hemisphere(10));
  Surface surface{mesh};
  std::vector<Patch> patches;
  PatchLists lists;
  ShapeGatherer gatherer{surface};
  PatchShape shape;

  Cap() : patches(one_patch(mesh)), lists(surface, patches) {
    const std::vector<std::uint32_t> first = {0};
    gatherer.gather(lists, first, nullptr, shape);
  }
  static std::vector<Patch> one_patch(const NormalMesh& mesh) {
    std::vector<Patch> patches(1);
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) patches[0].faces.push_back(f);
    return patches;
  }
};

TEST(OuterHull, holds_the_hull_of_all_it_has_grown_by) {
  Cap cap;
  OuterHull outer;
  ShrunkHull first;
  ASSERT_EQ(outer.build(cap.shape, cap.gatherer, first), HullKind::solid);
  HullBuilder scratch;
  Random random(3);
  std::vector<PointF> points = cap.shape.points;
  int grown = 0;
  while (!outer.full()) {
    const PointF p = random_point(random, 0.75F);
    // Every other growth is undone, and must leave nothing behind.
    grown += outer.grow(p, scratch) != nullptr ? 1 : 0;
    if (grown % 2 == 0) {
      outer.take_back();
      if (grown++ > 60) break;
      continue;
    }
    outer.keep();
    points.push_back(p);
    for (int i = 0; i < 20; ++i) {
      const Corners triangle = random_triangle(random);
      if (enters_whole(points, triangle)) {
        EXPECT_TRUE(enters(first, triangle) || outer.parts_entered_by(triangle)) << grown;
      } else if (!enters(first, triangle)) {
        EXPECT_FALSE(outer.parts_entered_by(triangle)) << grown;
      }
    }
  }
  EXPECT_GT(grown, 10);
}

TEST(OuterHull, a_point_inside_does_not_grow_it) {
  Cap cap;
  OuterHull outer;
  ShrunkHull first;
  ASSERT_EQ(outer.build(cap.shape, cap.gatherer, first), HullKind::solid);
  HullBuilder scratch;
  EXPECT_EQ(outer.grow(cap.shape.points[7], scratch), nullptr);
  EXPECT_NE(outer.grow({0, 0, 3}, scratch), nullptr);
}

TEST(OuterHull_guests, are_kept_once_a_face_and_asked_again_beyond_their_planes) {
  Cap cap;
  OuterHull outer;
  ShrunkHull first;
  ASSERT_EQ(outer.build(cap.shape, cap.gatherer, first), HullKind::solid);
  const BoundingPlane floor{{0, 0, -1}, 0};
  outer.admit(4, {floor});
  outer.take_back();
  EXPECT_TRUE(outer.guests().empty());
  outer.admit(4, {floor});
  outer.keep();
  outer.admit(4, {floor});
  outer.keep();
  ASSERT_EQ(outer.guests().size(), 1U);
  EXPECT_TRUE(outer.guests()[0].stays_out({0, 0, 1}));
  EXPECT_FALSE(outer.guests()[0].stays_out({0, 0, -1}));
}

TEST(GrowingHull_many_points_in_planes, is_the_hull) {
  // Grids on a cube's faces: most points are on the hull when they come, and not strictly outside.
  std::vector<PointF> points;
  constexpr int kGrid = 7;
  for (int x = 0; x < kGrid; ++x)
    for (int y = 0; y < kGrid; ++y)
      for (int z = 0; z < kGrid; ++z)
        if (x % (kGrid - 1) == 0 || y % (kGrid - 1) == 0 || z % (kGrid - 1) == 0)
          points.push_back({0.1F * static_cast<float>(x), 0.1F * static_cast<float>(y),
                            0.1F * static_cast<float>(z)});
  Random random(4);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(points.begin(), points.end(), random);
    std::uint32_t c = 2;
    while (collinear(points[0], points[1], points[c])) ++c;
    GrowingHull hull(points);
    const std::vector<std::uint32_t> seed = {0, 1, c};
    hull.start(seed, false);
    for (int again = 0; again < 2; ++again)
      for (std::uint32_t v = 0; v < points.size(); ++v)
        ASSERT_TRUE(hull.insert(v, v == 0 ? GrowingHull::kNone : v - 1));
    EXPECT_EQ(judge_hull(points, canonical_hull(points, hull.triangles()).mesh), "") << round;
  }
}

}  // namespace
}  // namespace palpate::bake

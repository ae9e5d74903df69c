// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/crossings.hpp"

#include <gtest/gtest.h>

#include <random>

#include "mesh_support.hpp"

namespace palpate::bake::testing {
namespace {

using Integers = std::array<std::int64_t, 3>;

std::int64_t orientation(const Integers& a, const Integers& b, const Integers& c,
                         const Integers& d) {
  std::int64_t m[3][3];
  for (std::size_t i = 0; i < 3; ++i) {
    m[0][i] = b[i] - a[i];
    m[1][i] = c[i] - a[i];
    m[2][i] = d[i] - a[i];
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

struct Answer {
  bool cross = false, generic = true;  ///< generic: no four of the points in one plane
};

/// Does an edge of the second triangle pass through the first one? Exact in integers.
void pierce(const std::array<Integers, 3>& t, const std::array<Integers, 3>& other,
            Answer& answer) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Integers &p = other[i], &q = other[(i + 1) % 3];
    const std::int64_t sides[] = {orientation(t[0], t[1], t[2], p),
                                  orientation(t[0], t[1], t[2], q), orientation(p, q, t[0], t[1]),
                                  orientation(p, q, t[1], t[2]), orientation(p, q, t[2], t[0])};
    for (const std::int64_t side : sides) answer.generic &= side != 0;
    const bool through = (sides[2] > 0) == (sides[3] > 0) && (sides[3] > 0) == (sides[4] > 0);
    answer.cross |= (sides[0] > 0) != (sides[1] > 0) && through;
  }
}

TEST(Crossings, Random_triangles_agree_with_brute_force) {
  std::mt19937 random(5);
  Mesh mesh;
  std::vector<std::array<Integers, 3>> triangles;
  for (std::uint32_t f = 0; f < 300; ++f) {
    triangles.emplace_back();
    for (Integers& p : triangles.back()) {
      for (std::int64_t& x : p) x = static_cast<std::int64_t>(random() % 2001) - 1000;
      mesh.points.push_back(
          {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
    }
    mesh.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  const auto pairs = crossing_pairs(mesh);
  ASSERT_TRUE(pairs);
  std::size_t compared = 0;
  for (std::uint32_t a = 0; a < 300; ++a) {
    for (std::uint32_t b = a + 1; b < 300; ++b) {
      Answer answer;
      pierce(triangles[a], triangles[b], answer);
      pierce(triangles[b], triangles[a], answer);
      if (!answer.generic) continue;
      ++compared;
      EXPECT_EQ(std::binary_search(pairs->begin(), pairs->end(), std::pair(a, b)), answer.cross);
    }
  }
  EXPECT_GT(compared, 40000U);
}

std::size_t crossings(const Mesh& mesh) { return crossing_pairs(mesh).value().size(); }

TEST(Crossings, Neighbours_do_not_cross) {
  EXPECT_EQ(crossings(sphere()), 0U);
  EXPECT_EQ(crossings(sheet(4)), 0U);
}

TEST(Crossings, Faces_without_area_cross_nothing) {
  const std::array<Point, 3> face = {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}};
  for (const std::array<Point, 3>& flat :
       std::vector<std::array<Point, 3>>{{{{0.5, 0.5, -1}, {0.5, 0.5, 1}, {0.5, 0.5, 1}}},
                                         {{{0, 0, 0}, {0.5, 0.5, 1}, {0.5, 0.5, 1}}},
                                         {{{0.5, 0.5, -1}, {0.5, 0.5, 0}, {0.5, 0.5, 1}}}}) {
    EXPECT_FALSE(triangles_cross(face, flat));
    EXPECT_FALSE(triangles_cross(flat, face));
  }
}

TEST(Crossings, Fold_over_a_common_edge_is_found) {
  const Mesh folded = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  const Mesh flat = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_EQ(crossings(folded), 1U);
  EXPECT_EQ(crossings(flat), 0U);
}

TEST(Crossings, Face_through_a_common_vertex_is_found) {
  const Mesh through = {{{0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {2, 0, -1}, {2, 0, 1}},
                        {{0, 1, 2}, {0, 3, 4}}};
  const Mesh beside = {{{0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 0, -1}, {-2, 0, 1}},
                       {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_EQ(crossings(through), 1U);
  EXPECT_EQ(crossings(beside), 0U);
}

TEST(Crossings, Sheets_cut_apart_do_not_cross) {
  EXPECT_EQ(crossings(together(cube(), cube({1, 1, 0}))), 0U);
}

TEST(Crossings, Touching_and_overlapping_faces_are_found) {
  EXPECT_GT(crossings(together(cube(), cube({0.5, 0.5, 1}))), 0U);
  EXPECT_EQ(crossings(together(sheet(1), sheet(1))), 2U);
}

TEST(Crossings, Faces_without_area_take_no_part) {
  const Mesh mesh = {
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.2, 0.2, 0}, {0.2, 0.2, 1}},
      {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_EQ(crossings(mesh), 0U);
}

TEST(Crossings, Heap_of_copies_gives_up) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    mesh.points.insert(mesh.points.end(), {{0, 0, 1e-6 * i}, {1, 0, 1 - 1e-6 * i}, {0, 1, 0}});
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_FALSE(crossing_pairs(mesh));
}

}  // namespace
}  // namespace palpate::bake::testing

// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/support_area.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "rt_core/convex/support.hpp"

namespace palpate::levels {
namespace {

using convex::Hull;
using image::Vertex;

/// A pyramid over a convex pentagon at z = 0, whose areas no linear function has. The order of its
/// vertices is not that round the pentagon.
const std::vector<Vertex> kPyramid{{{0.1f, 0.1f, 1.0f}, 7.0f},   {{1.0f, 0.0f, 0.0f}, 1.0f},
                                   {{-0.7f, 0.6f, 0.0f}, 2.0f},  {{0.3f, 0.9f, 0.0f}, 5.0f},
                                   {{-0.8f, -0.5f, 0.0f}, 3.0f}, {{0.4f, -0.9f, 0.0f}, 4.0f}};
constexpr std::array<std::uint32_t, 5> kRound{1, 3, 2, 4, 5};

Hull pyramid() { return {kPyramid.data(), 6, nullptr, nullptr, 1}; }

/// The same with lists of neighbours: the tip is joined to all, the others to those beside them.
struct Joined {
  std::vector<std::uint32_t> starts{0};
  std::vector<std::uint32_t> neighbours;
  Joined() {
    for (std::uint32_t v = 0; v < 6; ++v) {
      if (v == 0) neighbours = {1, 2, 3, 4, 5};
      for (std::size_t i = 0; v != 0 && i < 5; ++i) {
        if (kRound[i] == v) {
          neighbours.insert(neighbours.end(), {0, kRound[(i + 4) % 5], kRound[(i + 1) % 5]});
        }
      }
      starts.push_back(static_cast<std::uint32_t>(neighbours.size()));
    }
  }
  [[nodiscard]] Hull hull() const {
    return {kPyramid.data(), 6, starts.data(), neighbours.data(), 1};
  }
};

Vec3d corner(std::uint32_t vertex) { return convex::position(pyramid(), vertex); }

/// Barycentric coordinates of a point at z = 0.
std::array<double, 3> weights_of(const std::array<std::uint32_t, 3>& t, Vec3d p) {
  const auto doubled = [](Vec3d a, Vec3d b, Vec3d c) { return cross(b - a, c - a).z; };
  const Vec3d a = corner(t[0]), b = corner(t[1]), c = corner(t[2]);
  const double whole = doubled(a, b, c);
  return {doubled(p, b, c) / whole, doubled(a, p, c) / whole, doubled(a, b, p) / whole};
}

double area_at(const Hull& hull, const std::array<std::uint32_t, 3>& t,
               const std::array<double, 3>& w) {
  const std::uint32_t vertices[3] = {t[0], t[1], t[2]};
  const double weights[3] = {w[0], w[1], w[2]};
  return support_area(hull, {vertices, weights, 3});
}

/// Over all points of the pentagon: every triangle of its corners that holds the point.
template <class Check>
void for_points_and_triangles(const Check& check) {
  for (double x = -0.8; x < 1; x += 0.0371) {
    for (double y = -0.9; y < 0.9; y += 0.0413) {
      const Vec3d p{x, y, 0};
      for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = i + 1; j < 5; ++j) {
          for (std::size_t k = j + 1; k < 5; ++k) {
            const std::array t{kRound[i], kRound[j], kRound[k]};
            const auto w = weights_of(t, p);
            if (w[0] > 0 && w[1] > 0 && w[2] > 0) check(p, t, w);
          }
        }
      }
    }
  }
}

TEST(SupportArea, does_not_depend_on_the_triangle_that_a_query_ends_with) {
  const Joined joined;
  Vec3d last{2, 2, 2};
  double first = 0;
  std::size_t compared = 0;
  for_points_and_triangles([&](Vec3d p, const auto& t, const auto& w) {
    const double area = area_at(pyramid(), t, w);
    ASSERT_DOUBLE_EQ(area_at(joined.hull(), t, w), area);
    if (p == last) {
      ASSERT_NEAR(area, first, 1e-12) << p.x << " " << p.y;
      ++compared;
    }
    last = p;
    first = area;
  });
  EXPECT_GT(compared, 2000u);
}

TEST(SupportArea, is_linear_along_the_edges_of_a_face_and_in_the_triangles_about_one_vertex) {
  for_points_and_triangles([&](Vec3d, const auto& t, const auto& w) {
    // Vertex 1 comes first, so its fan is (1, 3, 2), (1, 2, 4) and (1, 4, 5).
    constexpr std::array<std::array<std::uint32_t, 3>, 3> kFan{{{1, 3, 2}, {1, 2, 4}, {1, 4, 5}}};
    for (const auto& of_fan : kFan) {
      if (t != of_fan) continue;
      const double linear = w[0] * static_cast<double>(kPyramid[t[0]].support_area) +
                            w[1] * static_cast<double>(kPyramid[t[1]].support_area) +
                            w[2] * static_cast<double>(kPyramid[t[2]].support_area);
      ASSERT_NEAR(area_at(pyramid(), t, w), linear, 1e-12);
    }
  });
  for (std::size_t i = 0; i < 5; ++i) {
    const std::uint32_t from = kRound[i];
    const std::uint32_t to = kRound[(i + 1) % 5];
    const std::uint32_t beyond = kRound[(i + 3) % 5];
    for (double share = 0.1; share < 1; share += 0.1) {
      const double on_edge = (1 - share) * static_cast<double>(kPyramid[from].support_area) +
                             share * static_cast<double>(kPyramid[to].support_area);
      constexpr double kHair = 1e-9;
      const std::array weights{(1 - share) * (1 - kHair), share * (1 - kHair), kHair};
      EXPECT_NEAR(area_at(pyramid(), {from, to, beyond}, weights), on_edge, 1e-7);
    }
  }
}

TEST(SupportArea, is_that_of_the_combination_on_vertices_edges_and_triangular_faces) {
  const std::uint32_t vertices[3] = {0, 1, 3};
  const double weights[3] = {0.25, 0.25, 0.5};
  EXPECT_EQ(support_area(pyramid(), {vertices, weights, 3}), 0.25 * 7 + 0.25 * 1 + 0.5 * 5);
  const double half[3] = {0.5, 0.5, 0};
  EXPECT_EQ(support_area(pyramid(), {vertices, half, 2}), 4);
  const double whole[3] = {1, 0, 0};
  EXPECT_EQ(support_area(pyramid(), {vertices, whole, 1}), 7);
}

TEST(SupportArea, is_finite_where_vertices_coincide) {
  const std::vector<Vertex> same(5, Vertex{{0.5f, 0.5f, 0.5f}, 2.0f});
  const Hull hull{same.data(), 5, nullptr, nullptr, 1};
  const std::uint32_t vertices[3] = {1, 2, 4};
  const double weights[3] = {0.25, 0.25, 0.5};
  EXPECT_EQ(support_area(hull, {vertices, weights, 3}), 2);
}

}  // namespace
}  // namespace palpate::levels

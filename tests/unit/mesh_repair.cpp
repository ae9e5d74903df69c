// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host_bake/mesh/check.hpp"
#include "mesh_support.hpp"

namespace palpate::bake::testing {
namespace {

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const Face& f : mesh.faces) {
    const Point &a = mesh.points[f[0]], &b = mesh.points[f[1]], &c = mesh.points[f[2]];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

/// Merges vertices at equal positions.
Mesh welded(Mesh mesh) {
  for (Face& f : mesh.faces) {
    for (std::uint32_t& v : f) {
      const auto first = std::find(mesh.points.begin(), mesh.points.end(), mesh.points[v]);
      v = static_cast<std::uint32_t>(first - mesh.points.begin());
    }
  }
  return mesh;
}

TEST(Repair, Sound_mesh_stays_as_it_is) {
  for (const Mesh& sound :
       {sphere(), sheet(3), together(sphere({0, 0, 0}, 2), inside_out(sphere()))}) {
    Mesh mesh = sound;
    EXPECT_TRUE(repair(mesh).done.empty());
    EXPECT_EQ(mesh.points, sound.points);
    EXPECT_EQ(mesh.faces, sound.faces);
  }
}

TEST(Repair, Degenerate_and_duplicate_faces_go) {
  Mesh mesh = cube();
  mesh.faces.insert(mesh.faces.begin() + 3, {1, 1, 2});
  mesh.faces.push_back({3, 2, 0});
  mesh.faces.push_back({0, 2, 3});
  const RepairReport report = repair(mesh);
  EXPECT_EQ(report.done,
            (std::vector<std::string>{"1 degenerate faces removed", "2 duplicate faces removed"}));
  EXPECT_EQ(mesh.faces, cube().faces);
}

TEST(Repair, Random_orientation_becomes_outward) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    Mesh mesh = together(sphere(), cube({5, 0, 0}));
    for (Face& f : mesh.faces) {
      if (random() % 2 == 0) std::swap(f[0], f[1]);
    }
    repair(mesh);
    EXPECT_TRUE(check(mesh).clean());
    EXPECT_NEAR(volume(mesh), volume(sphere()) + 1, 1e-9);
  }
}

TEST(Repair, Majority_of_an_open_surface_keeps_its_side) {
  Mesh mesh = sheet(4);
  for (std::size_t f = 0; f < 10; ++f) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
  const RepairReport report = repair(mesh);
  EXPECT_EQ(report.done,
            (std::vector<std::string>{"10 faces turned to agree with their neighbours"}));
  EXPECT_TRUE(check(mesh).clean());
}

TEST(Repair, Inside_out_shell_keeps_its_cavity) {
  const Mesh shell = together(sphere({0, 0, 0}, 2), inside_out(sphere()));
  Mesh mesh = inside_out(shell);
  repair(mesh);
  EXPECT_TRUE(check(mesh).clean());
  EXPECT_NEAR(volume(mesh), volume(shell), 1e-9);
}

TEST(Repair, Solids_that_touch_come_apart_closed) {
  for (const Point low : {Point{1, 1, 1}, Point{1, 1, 0}}) {  // at a vertex, along an edge
    Mesh mesh = welded(together(cube(), cube(low)));
    EXPECT_FALSE(check(mesh).bakeable());
    repair(mesh);
    const CheckReport report = check(mesh);
    EXPECT_TRUE(report.clean());
    EXPECT_EQ(report.closed_components, 2U);
    EXPECT_EQ(report.boundary_edges, 0U);
    EXPECT_EQ(mesh.points.size(), 16U);
  }
}

TEST(Repair, Fin_becomes_a_sheet_of_its_own) {
  Mesh mesh = cube();
  mesh.points.push_back({-1, -1, 0.5});
  mesh.faces.push_back({0, 4, 8});
  repair(mesh);
  const CheckReport report = check(mesh);
  EXPECT_TRUE(report.bakeable());
  EXPECT_EQ(report.components, 2U);
  EXPECT_EQ(report.closed_components, 1U);
}

TEST(Repair, Shared_wall_leaves_open_sheets_and_loses_no_surface) {
  Mesh mesh = welded(together(cube(), cube({1, 0, 0})));  // the wall is there twice, back to back
  const std::size_t faces = mesh.faces.size();
  repair(mesh);
  const CheckReport report = check(mesh);
  EXPECT_TRUE(report.bakeable());
  EXPECT_EQ(mesh.faces.size(), faces - 2);
}

TEST(Repair, One_sided_surface_is_cut_along_a_seam) {
  Mesh mesh;  // a strip of quads round a ring, half a turn in all: Moebius
  constexpr std::uint32_t kQuads = 9;
  for (std::uint32_t i = 0; i < kQuads; ++i) {
    const double turn = 6.283185307179586 * i / kQuads, half = turn / 2;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1 + side * std::cos(half);
      mesh.points.push_back({r * std::cos(turn), r * std::sin(turn), side * std::sin(half)});
    }
  }
  for (std::uint32_t i = 0; i < kQuads; ++i) {
    const bool last = i + 1 == kQuads;
    const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.faces.insert(mesh.faces.end(), {Face{a, c, b}, Face{b, c, d}});
  }
  EXPECT_FALSE(check(mesh).bakeable());
  repair(mesh);
  const CheckReport report = check(mesh);
  EXPECT_TRUE(report.bakeable());
  EXPECT_EQ(report.boundary_edges, 2 * kQuads + 2);
  EXPECT_EQ(report.crossings, 0U);
}

TEST(Repair, Unreferenced_vertices_go) {
  Mesh mesh = cube();
  mesh.points.insert(mesh.points.begin(), {7, 7, 7});
  for (Face& f : mesh.faces) {
    for (std::uint32_t& v : f) ++v;
  }
  repair(mesh);
  EXPECT_EQ(mesh.points, cube().points);
  EXPECT_EQ(mesh.faces, cube().faces);
}

/// Random triangles over few vertices: every kind of trouble at once.
Mesh random_soup(std::mt19937& random, std::uint32_t vertices, std::size_t faces) {
  Mesh mesh;
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (std::uint32_t i = 0; i < vertices; ++i) {
    mesh.points.push_back({coordinate(random), coordinate(random), coordinate(random)});
  }
  const auto vertex = [&] { return static_cast<std::uint32_t>(random() % vertices); };
  for (std::size_t i = 0; i < faces; ++i) mesh.faces.push_back({vertex(), vertex(), vertex()});
  return mesh;
}

TEST(Repair, Random_soups_end_bakeable_or_say_what_is_left) {
  std::mt19937 random(11);
  std::size_t fixed = 0;
  for (int round = 0; round < 300; ++round) {
    Mesh mesh = random_soup(random, 12, 4 + static_cast<std::size_t>(round) / 10);
    repair(mesh);
    const CheckReport report = check(mesh);
    for (const Finding& f : report.findings) {
      if (f.severity == Severity::note) continue;
      EXPECT_TRUE(f.rule == "non-manifold edge" || f.rule == "no triangles") << f.rule;
    }
    fixed += report.bakeable();
    Mesh again = mesh;
    if (report.bakeable()) {
      EXPECT_TRUE(repair(again).done.empty());
    }
  }
  EXPECT_GT(fixed, 250U);
}

}  // namespace
}  // namespace palpate::bake::testing

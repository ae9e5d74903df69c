// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/check.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "host_bake/base/error.hpp"
#include "mesh_support.hpp"

namespace palpate::bake::testing {
namespace {

/// The places of a rule, or 0.
std::size_t count(const CheckReport& report, const std::string& rule) {
  for (const Finding& f : report.findings) {
    if (f.rule == rule) return f.count;
  }
  return 0;
}

void expect_refused(const Mesh& mesh, const std::string& rule, std::size_t places) {
  const CheckReport report = check(mesh);
  EXPECT_EQ(count(report, rule), places) << rule;
  EXPECT_FALSE(report.bakeable()) << rule;
  EXPECT_THROW(require_bakeable(report, "a.obj", false), InputRefused) << rule;
}

TEST(Check, Closed_surface_is_clean) {
  const CheckReport report = check(sphere());
  EXPECT_TRUE(report.clean());
  EXPECT_TRUE(report.bakeable());
  EXPECT_EQ(report.components, 1U);
  EXPECT_EQ(report.closed_components, 1U);
  EXPECT_EQ(report.boundary_edges, 0U);
  EXPECT_EQ(report.faces, 128U);
  EXPECT_NO_THROW(require_bakeable(report, "a.obj", true));
}

TEST(Check, Open_surface_is_clean_and_its_boundary_counted) {
  const CheckReport report = check(sheet(3));
  EXPECT_TRUE(report.clean());
  EXPECT_EQ(report.boundary_edges, 12U);
  EXPECT_EQ(report.closed_components, 0U);
}

TEST(Check, Components_are_numbered_by_first_face) {
  const CheckReport report = check(together(sheet(1), cube({5, 5, 5})));
  EXPECT_EQ(report.components, 2U);
  EXPECT_EQ(report.component_closed, (std::vector<char>{0, 1}));
  EXPECT_EQ(report.face_component[1], 0U);
  EXPECT_EQ(report.face_component[2], 1U);
}

TEST(Check, Empty_mesh_is_an_error) { expect_refused({}, "no triangles", 1); }

TEST(Check, Bad_numbers_are_errors) {
  Mesh mesh = cube();
  mesh.points[3][1] = std::numeric_limits<double>::quiet_NaN();
  mesh.points[4][2] = std::numeric_limits<double>::infinity();
  expect_refused(mesh, "coordinate not finite", 2);
  mesh = cube();
  mesh.faces[2][1] = 8;
  expect_refused(mesh, "index out of range", 1);
}

TEST(Check, Degenerate_face_is_found) {
  Mesh mesh = cube();
  mesh.faces.push_back({1, 1, 2});
  expect_refused(mesh, "degenerate face", 1);
}

TEST(Check, Duplicate_face_is_found_whichever_way_round) {
  Mesh mesh = cube();
  mesh.faces.push_back({mesh.faces[0][1], mesh.faces[0][2], mesh.faces[0][0]});
  expect_refused(mesh, "duplicate face", 1);
  mesh.faces.push_back({mesh.faces[1][1], mesh.faces[1][0], mesh.faces[1][2]});
  expect_refused(mesh, "duplicate face", 2);
}

TEST(Check, Face_without_area_is_only_a_note) {
  // The square's left side has a vertex in its middle, filled by a collinear face.
  const Mesh mesh = {{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 1, 0}},
                     {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}};
  const CheckReport report = check(mesh);
  EXPECT_EQ(count(report, "face without area"), 1U);
  EXPECT_TRUE(report.bakeable());
  EXPECT_FALSE(report.clean());
}

TEST(Check, Non_manifold_edge_is_found) {
  Mesh mesh = cube();
  mesh.points.push_back({-1, -1, 0.5});
  mesh.faces.push_back({0, 4, 8});
  expect_refused(mesh, "non-manifold edge", 1);
  EXPECT_EQ(check(mesh).findings.front().first, (std::vector<Point>{{0, 0, 0.5}}));
}

TEST(Check, Non_manifold_vertex_is_found) {
  Mesh mesh = together(cube(), cube({1, 1, 1}));
  for (Face& f : mesh.faces) std::replace(f.begin(), f.end(), 8U, 7U);
  expect_refused(mesh, "non-manifold vertex", 1);
  EXPECT_EQ(count(check(mesh), "non-manifold edge"), 0U);
}

TEST(Check, Inconsistent_orientation_is_found) {
  Mesh mesh = cube();
  std::swap(mesh.faces[5][0], mesh.faces[5][1]);
  expect_refused(mesh, "inconsistent orientation", 3);
}

TEST(Check, Inside_out_solid_is_found) {
  expect_refused(inside_out(sphere()), "inward orientation", 1);
  expect_refused(inside_out(sphere({1e6, 0, 0}, 1e-3)), "inward orientation", 1);
}

TEST(Check, Cavity_is_legal_and_body_in_body_too) {
  const Mesh outer = sphere({0, 0, 0}, 2), inner = sphere({0.1, 0.2, 0.3}, 1);
  EXPECT_TRUE(check(together(outer, inside_out(inner))).clean());
  EXPECT_TRUE(check(together(outer, inner)).clean());
}

TEST(Check, Inside_out_shell_is_found_whole) {
  const Mesh shell = together(sphere({0, 0, 0}, 2), inside_out(sphere()));
  expect_refused(inside_out(shell), "inward orientation", 2);
}

TEST(Check, Body_in_a_cavity_must_look_outward) {
  const Mesh shell = together(sphere({0, 0, 0}, 3), inside_out(sphere({0, 0, 0}, 2)));
  EXPECT_TRUE(check(together(shell, sphere())).clean());
  expect_refused(together(shell, inside_out(sphere())), "inward orientation", 1);
}

TEST(Check, Ray_through_vertices_and_edges_counts_once) {
  // Straight above the first vertex of the inner octahedron lie a vertex, an edge's middle, then a
  // vertex of the outer cubes.
  const Mesh inner = inside_out(sphere({0, 0, 0}, 1, 0));
  for (const Point low : {Point{-4, -4, -4}, Point{-3, -4, -4}, Point{-3, -3, -4}}) {
    EXPECT_TRUE(check(together(cube(low, 8), inner)).clean()) << low[0] << " " << low[1];
  }
  EXPECT_TRUE(check(together(inner, sphere({1, 0, 0}, 9, 1))).clean());
}

/// A sphere without the faces at its top.
Mesh bowl(double below) {
  Mesh mesh = sphere({0, 0, 0}, 1, 3);
  std::erase_if(mesh.faces, [&mesh, below](const Face& f) { return mesh.points[f[0]][2] > below; });
  return mesh;
}

TEST(Check, Nearly_closed_inside_out_surface_is_found) {
  EXPECT_TRUE(check(bowl(0.9)).bakeable());
  expect_refused(inside_out(bowl(0.9)), "inward orientation", 1);
}

TEST(Check, Inside_of_an_open_bowl_is_only_doubted) {
  const CheckReport report = check(inside_out(bowl(0)));
  EXPECT_TRUE(report.bakeable());
  EXPECT_EQ(count(report, "perhaps inward orientation"), 1U);
  EXPECT_EQ(count(check(bowl(0)), "perhaps inward orientation"), 0U);
}

TEST(Check, Tiny_component_is_noted) {
  const CheckReport report = check(together(sphere(), sphere({2, 0, 0}, 1e-4)));
  EXPECT_TRUE(report.bakeable());
  EXPECT_EQ(count(report, "tiny component"), 1U);
}

TEST(Check, Unreferenced_vertex_is_noted) {
  Mesh mesh = cube();
  mesh.points.push_back({7, 7, 7});
  const CheckReport report = check(mesh);
  EXPECT_TRUE(report.bakeable());
  EXPECT_EQ(count(report, "unreferenced vertex"), 1U);
}

TEST(Check, Self_intersection_is_noted_and_refused_when_strict) {
  const CheckReport report = check(together(cube(), cube({0.5, 0.4, 0.3})));
  EXPECT_TRUE(report.bakeable());
  EXPECT_GT(report.crossings, 0U);
  EXPECT_EQ(count(report, "self-intersection"), report.crossings);
  EXPECT_TRUE(std::is_sorted(report.crossing_faces.begin(), report.crossing_faces.end()));
  EXPECT_NO_THROW(require_bakeable(report, "a.obj", false));
  EXPECT_THROW(require_bakeable(report, "a.obj", true), InputRefused);
}

TEST(Check, Refusal_names_rule_count_places_and_fix) {
  Mesh mesh = cube();
  mesh.faces.push_back({1, 1, 2});
  try {
    require_bakeable(check(mesh), "a.obj", false);
    FAIL();
  } catch (const InputRefused& refused) {
    EXPECT_STREQ(
        refused.what(),
        "1 x degenerate face at (0.666667 0.333333 0): a.obj: palpate's --repair fixes it");
  }
}

TEST(Check, Scale_does_not_matter) {
  for (const double size : {1e-12, 1e-6, 1.0, 1e6, 1e12}) {
    EXPECT_TRUE(check(cube({0, 0, 0}, size)).clean()) << size;
    expect_refused(inside_out(cube({0, 0, 0}, size)), "inward orientation", 1);
  }
}

}  // namespace
}  // namespace palpate::bake::testing

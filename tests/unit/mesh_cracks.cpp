// SPDX-License-Identifier: GPL-3.0-or-later
// Soups whose corners differ by rounding become one surface; those with wider cracks are refused by
// name, whatever repair() makes of them.
#include "host_bake/mesh/cracks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host_bake/bake.hpp"
#include "host_bake/base/error.hpp"
#include "host_bake/mesh/check.hpp"
#include "host_bake/pack/aligned.hpp"
#include "mesh_support.hpp"

namespace palpate::bake::testing {
namespace {

/// Each face gets corners of its own, each off by up to `off` along every axis.
Mesh soup_of(const Mesh& mesh, double off, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> error(-off, off);
  Mesh soup;
  for (const Face& face : mesh.faces) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (const std::uint32_t v : face) {
      const Point& p = mesh.points[v];
      soup.points.push_back({p[0] + error(random), p[1] + error(random), p[2] + error(random)});
    }
    soup.faces.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// The corners of each face, starting at the smallest, in order: equal for equal surfaces.
std::vector<std::array<Point, 3>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<Point, 3>> triangles;
  for (const Face& f : mesh.faces) {
    std::array<Point, 3> t = {mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

Cracks cracks_in(const Mesh& mesh) { return find_cracks(mesh, sorted_sides(mesh.faces)); }

void expect_closed(const Mesh& mesh, std::size_t vertices, std::size_t faces) {
  const CheckReport report = check(mesh);
  EXPECT_TRUE(report.clean());
  EXPECT_EQ(report.vertices, vertices);
  EXPECT_EQ(report.faces, faces);
  EXPECT_EQ(report.components, 1U);
  EXPECT_EQ(report.closed_components, 1U);
  EXPECT_EQ(report.boundary_edges, 0U);
}

/// Off by a tenth of the tolerance: corners of one vertex always coincide.
constexpr double kOff = kCoincideRel / 10;

TEST(Cracks, Stl_with_corners_a_unit_of_float_apart_bakes_to_a_closed_body) {
  const ReadMesh read = read_mesh(PALPATE_TEST_DATA "/rounding_cracks.stl");
  EXPECT_EQ(read.welded.corners, 216U - 42U);
  EXPECT_GT(read.welded.largest_gap_m, 3e-9);
  EXPECT_LT(read.welded.largest_gap_m, 6e-9);
  EXPECT_NEAR(read.welded.largest_gap_rel, read.welded.largest_gap_m / 0.03, 1e-9);
  EXPECT_EQ(read.welded.collapsed_triangles, 0U);
  expect_closed(read.mesh, 42, 80);

  BakeReport report;
  const AlignedCopy image(bake::bake(read.mesh, check(read.mesh), {}, {}, report));
  ImageView view;
  ASSERT_EQ(validate(image.bytes(), view), Status::ok);
  EXPECT_EQ(view.header->source_triangles, 80U);
  EXPECT_EQ(view.header->flags & static_cast<std::uint32_t>(image::HeaderFlag::open), 0U);
}

TEST(Cracks, Float_soups_of_every_binary_format_are_welded) {
  const Mesh soup = soup_of(sphere({0, 0, 0}, 0.9), 0.9 * kCoordinateRoundingRel);
  for (const auto& [bytes, extension] :
       {std::pair{to_stl_binary(soup), ".stl"}, std::pair{to_off_binary(soup), ".off"},
        std::pair{to_ply_binary(soup, std::endian::little), ".ply"}}) {
    SCOPED_TRACE(extension);
    const ReadMesh read = read_as(bytes, extension);
    EXPECT_GT(read.welded.corners, 0U);
    expect_closed(read.mesh, sphere().points.size(), sphere().faces.size());
  }
}

TEST(Cracks, Welding_is_relative_to_the_radius) {
  for (const double size : {1e-9, 1.0, 1e9}) {
    const Point centre{3 * size, -2 * size, size};
    Mesh mesh = soup_of(sphere(centre, size), kOff * size);
    const Welded welded = weld_coincident(mesh);
    EXPECT_LE(welded.largest_gap_rel, kCoincideRel);
    EXPECT_NEAR(welded.largest_gap_m, welded.largest_gap_rel * size, 1e-6 * welded.largest_gap_m);
    expect_closed(mesh, sphere().points.size(), sphere().faces.size());
  }
}

TEST(Cracks, Welding_does_not_depend_on_the_order_of_faces_and_corners) {
  const Mesh soup = soup_of(sphere(), kOff);
  Mesh once = soup;
  weld_coincident(once);
  std::mt19937 random(7);
  for (int round = 0; round < 5; ++round) {
    Mesh mixed = soup;
    std::shuffle(mixed.faces.begin(), mixed.faces.end(), random);
    for (Face& f : mixed.faces) std::rotate(f.begin(), f.begin() + random() % 3, f.end());
    weld_coincident(mixed);
    EXPECT_EQ(triangles_of(mixed), triangles_of(once));
  }
}

TEST(Cracks, Vertices_are_numbered_by_their_first_use) {
  Mesh mesh = soup_of(sphere(), kOff);
  weld_coincident(mesh);
  std::uint32_t next = 0;
  for (const Face& f : mesh.faces) {
    for (const std::uint32_t v : f) {
      ASSERT_LE(v, next);
      next = std::max(next, v + 1);
    }
  }
  EXPECT_EQ(next, mesh.points.size());
}

TEST(Cracks, Mesh_without_them_stays_as_it_is) {
  const Mesh tiny = sphere({2, 0, 0}, 1e-9);  // closed, all of it within the tolerance
  for (const Mesh& sound : {sphere(), sheet(3), together(sphere(), tiny)}) {
    Mesh mesh = sound;
    EXPECT_EQ(weld_coincident(mesh).corners, 0U);
    EXPECT_EQ(mesh.points, sound.points);
    EXPECT_EQ(mesh.faces, sound.faces);
    EXPECT_TRUE(cracks_in(mesh).corners.empty());
  }
}

TEST(Cracks, Triangle_that_collapses_is_dropped_and_counted) {
  Mesh mesh = soup_of(cube(), kOff);
  const Point p = cube().points[0], q = cube().points[1];
  mesh.points.insert(mesh.points.end(), {p, {p[0], p[1] + kOff, p[2]}, q});
  mesh.faces.push_back({36, 37, 38});
  const Welded welded = weld_coincident(mesh);
  EXPECT_EQ(welded.collapsed_triangles, 1U);
  EXPECT_NE(describe(welded).find("1 triangles collapsed"), std::string::npos) << describe(welded);
  expect_closed(mesh, 8, 12);
}

TEST(Cracks, Triangle_that_was_degenerate_stays_for_the_check_to_name) {
  Mesh mesh = soup_of(cube(), kOff);
  mesh.faces.push_back({0, 0, 1});
  EXPECT_EQ(weld_coincident(mesh).collapsed_triangles, 0U);
  EXPECT_EQ(mesh.faces.size(), 13U);
}

TEST(Cracks, File_of_nothing_but_triangles_that_collapse_is_refused) {
  const std::string said = refusal("v 0 0 0\nv 1 0 0\nv 1 1e-9 0\nf 1 2 3\n", ".obj");
  EXPECT_NE(said.find("every triangle"), std::string::npos) << said;
  EXPECT_NE(said.find(".obj"), std::string::npos) << said;
}

TEST(Cracks, Fine_border_does_not_shrink_link_by_link) {
  constexpr std::uint32_t kLinks = 50;
  constexpr double kLink = kCoincideRel * 0.3;  // the radius is about a half
  Mesh fan;
  fan.points = {{0, 0, 1}};
  for (std::uint32_t i = 0; i <= kLinks; ++i) {
    fan.points.push_back({i * kLink, 0, 0});
    if (i > 0) fan.faces.push_back({0, i, i + 1});
  }
  Mesh mesh = fan;
  const Welded welded = weld_coincident(mesh);
  EXPECT_LE(welded.largest_gap_rel, kCoincideRel);
  EXPECT_EQ(welded.collapsed_triangles + mesh.faces.size(), fan.faces.size());
  EXPECT_GE(mesh.faces.size(), kLinks / 3);
}

TEST(Cracks, Many_corners_in_one_place_are_welded) {
  Mesh mesh;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> spread(0, 2 * kCoincideRel);
  for (std::uint32_t i = 0; i < 60000; ++i) {
    mesh.points.insert(mesh.points.end(), {{spread(random), spread(random), spread(random)},
                                           {1, std::sin(i), std::cos(i)},
                                           {1, std::sin(i + 0.5), std::cos(i + 0.5)}});
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Welded welded = weld_coincident(mesh);
  EXPECT_GT(welded.corners, 59000U);
  EXPECT_EQ(mesh.faces.size(), 60000U);
}

TEST(Cracks, Wider_ones_are_refused_by_name_and_not_repaired) {
  for (const double off : {1e-6, 1e-5, 2e-4}) {
    SCOPED_TRACE(off);
    Mesh mesh = soup_of(sphere({0, 0, 0}, 1, 1), off);
    weld_coincident(mesh);
    for (int round = 0; round < 2; ++round, repair(mesh)) {
      const CheckReport report = check(mesh);
      EXPECT_GT(report.components, 12U);
      const Finding& first = report.findings.at(0);
      EXPECT_EQ(first.rule, "corners nearly coincide");
      EXPECT_GT(first.largest_gap_m, off);
      EXPECT_LE(first.largest_gap_m, 2 * std::sqrt(3.0) * off);
      try {
        require_bakeable(report, "soup.stl", false);
        ADD_FAILURE() << "not refused";
      } catch (const InputRefused& refused) {
        const std::string said = refused.what();
        EXPECT_NE(said.find("corners nearly coincide (largest gap "), std::string::npos) << said;
        EXPECT_NE(said.find(": soup.stl: weld them"), std::string::npos) << said;
      }
    }
  }
}

TEST(Cracks, One_in_a_surface_that_is_whole_otherwise_is_found) {
  Mesh mesh = sphere();
  const Face first = mesh.faces[0];
  for (std::uint32_t& v : mesh.faces[0]) {  // one face comes off by 1e-5
    mesh.points.push_back(mesh.points[v]);
    for (double& x : mesh.points.back()) x *= 1 + 1e-5;
    v = static_cast<std::uint32_t>(mesh.points.size() - 1);
  }
  const Cracks cracks = cracks_in(mesh);
  EXPECT_EQ(cracks.corners.size(), 6U);
  EXPECT_NEAR(cracks.largest_gap_m, 1e-5, 1e-10);
  EXPECT_TRUE(std::ranges::count(cracks.corners, mesh.points[first[0]]));
}

TEST(Cracks, Written_ply_of_a_soup_is_not_welded_and_named) {
  const std::vector<std::byte> ply = to_ply(soup_of(sphere(), kOff));
  std::string bytes(ply.size(), '\0');
  std::memcpy(bytes.data(), ply.data(), ply.size());
  const ReadMesh read = read_as(bytes, ".ply");
  EXPECT_EQ(read.welded.corners, 0U);
  EXPECT_EQ(check(read.mesh).findings.at(0).rule, "corners nearly coincide");
}

TEST(Cracks, Sheets_that_touch_without_a_gap_have_none) {
  Mesh second = sheet(3);
  for (Point& p : second.points) p[0] += 3;
  EXPECT_TRUE(cracks_in(together(sheet(3), second)).corners.empty());
}

TEST(Cracks, Narrow_ribbons_and_slots_of_their_own_width_have_none) {
  Mesh ribbon, slot;
  for (std::uint32_t i = 0; i <= 4; ++i) {
    for (const double y : {0.0, 5e-4}) ribbon.points.push_back({static_cast<double>(i), y, 0});
    if (i == 0) continue;
    const std::uint32_t a = 2 * i - 2;
    ribbon.faces.insert(ribbon.faces.end(), {Face{a, a + 2, a + 3}, Face{a, a + 3, a + 1}});
  }
  EXPECT_TRUE(cracks_in(ribbon).corners.empty());
  slot = sheet(4);
  Mesh other = sheet(4);
  for (Point& p : other.points) p[0] += 4.02;  // wider than a thousandth of the radius
  EXPECT_TRUE(cracks_in(together(slot, other)).corners.empty());
}

}  // namespace
}  // namespace palpate::bake::testing

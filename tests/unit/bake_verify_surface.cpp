// SPDX-License-Identifier: GPL-3.0-or-later
// verify() accepts what contacts see of good surfaces and finds each planted violation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "host_bake/regions/normal_cone.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

constexpr std::size_t kProofs = 7;  // of the surface

// The image's records, which are in memory of the test's own.
template <class T>
std::span<T> writable(std::span<const T> records) {
  return {const_cast<T*>(records.data()), records.size()};
}

struct Records {
  explicit Records(const ImageView& view)
      : triangles(writable(view.region_triangles)),
        vertices(writable(view.surface_vertices)),
        normals(writable(view.vertex_normals)),
        edges(writable(view.surface_edges)),
        runs(writable(view.surface_runs)),
        corners(writable(view.triangle_vertices)),
        grid(const_cast<image::ProximityGrid*>(view.proximity_grid)),
        bricks(writable(view.proximity_bricks)),
        cells(writable(view.proximity_cells)) {}
  std::span<image::RegionTriangle> triangles;
  std::span<image::SurfaceVertex> vertices;
  std::span<image::SurfaceNormal> normals;
  std::span<std::uint32_t> edges;
  std::span<image::SurfaceRun> runs;
  std::span<image::TriangleVertices> corners;
  image::ProximityGrid* grid;
  std::span<std::uint32_t> bricks;
  std::span<std::uint32_t> cells;
};

Mesh bumpy() { return bumpy_ball(14, 20, 1); }

std::vector<std::string> failures(const ImageView& view) {
  std::vector<std::string> out;
  for (const bake::Proof& p : bake::verify(view)) {
    if (!p.holds) out.push_back(p.invariant);
  }
  return out;
}

/// What fails after an edit of the records of a bumpy ball's image.
template <class Edit>
std::vector<std::string> failures_after(Edit edit) {
  const BakedBody body(bumpy(), bake::ForEngine::regions);
  edit(Records(body.view));
  return failures(body.view);
}

using Names = std::vector<std::string>;
const std::string kVertices = "surface vertices are those of the triangles";
const std::string kHulls = "hulls of normals hold those of the faces";
const std::string kPseudonormals = "pseudonormals are the means of the faces' normals";
const std::string kConcave = "concave normals are those beside concave edges";
const std::string kEdges = "listed edges are the convex ones";
const std::string kCones = "cones of regions hold their normals";
const std::string kCells = "cells name the triangle nearest to them";

void turn(float (&n)[3], double angle) {
  const Vec3d from = vec3d(n);
  const Vec3d to = std::cos(angle) * from + std::sin(angle) * across(from);
  n[0] = static_cast<float>(to.x);
  n[1] = static_cast<float>(to.y);
  n[2] = static_cast<float>(to.z);
}

image::SurfaceVertex& with_hull(const Records& r) {
  return *std::ranges::find_if(r.vertices, [](const auto& v) { return v.hull_normals > 2; });
}

image::SurfaceVertex& with_concave(const Records& r) {
  return *std::ranges::find_if(r.vertices, [](const auto& v) { return v.concave_normals > 1; });
}

TEST(VerifySurface, Good_surfaces_hold) {
  for (const Mesh& mesh : {bumpy(), bowl(8, 12, 1), box(1, 0.7, 0.4), gear(8, 1, 0.5),
                           ring(24, 12, 1, 0.3), quartered(box(1, 1, 1), 3)}) {
    const BakedBody body(mesh, bake::ForEngine::regions);
    EXPECT_EQ(failures(body.view), Names{});
  }
}

TEST(VerifySurface, Proofs_say_how_much_they_checked) {
  const BakedBody body(bumpy(), bake::ForEngine::regions);
  const std::vector<bake::Proof> proofs = bake::verify(body.view);
  const std::string vertices = std::to_string(body.view.surface_vertices.size()) + " vertices";
  const auto last = std::span(proofs).last(kProofs);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(last[i].found, vertices);
  EXPECT_EQ(last[4].found, std::to_string(body.view.surface_edges.size()) + " edges");
  EXPECT_EQ(last[5].found, std::to_string(body.view.regions.size()) + " regions");
  EXPECT_NE(last[6].found.find(" cells"), std::string::npos);
}

TEST(VerifySurface, Images_without_regions_have_nothing_to_prove) {
  const BakedBody body(box(1, 1, 1), bake::ForEngine::levels);
  const std::vector<bake::Proof> proofs = bake::verify(body.view);
  for (const bake::Proof& p : std::span(proofs).last(kProofs)) EXPECT_EQ(p.found, "no regions");
}

TEST(VerifySurface, Moved_vertex_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) {
              float& x = r.vertices[7].position[0];
              x = std::nextafter(x, 2.0f);
            }),
            Names{kVertices});
}

/// The first of two neighbouring runs that has something.
template <class Count>
image::SurfaceRun* run_with(const Records& r, Count count) {
  const auto run = std::ranges::find_if(r.runs.first(r.runs.size() - 1),
                                        [&](const auto& s) { return s.*count > 0; });
  return &*run;
}

TEST(VerifySurface, Vertex_in_another_run_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) {
              image::SurfaceRun* run = run_with(r, &image::SurfaceRun::vertices);
              --run[0].vertices;
              --run[1].first_vertex;
              ++run[1].vertices;
            }),
            Names{kVertices});
}

TEST(VerifySurface, Runs_that_leave_out_a_vertex_are_found) {
  EXPECT_EQ(failures_after(
                [](const Records& r) { --run_with(r, &image::SurfaceRun::vertices)->vertices; }),
            Names{kVertices});
}

TEST(VerifySurface, Corner_at_another_vertex_is_found) {
  const auto found = failures_after(
      [](const Records& r) { std::swap(r.corners[3].corner[0], r.corners[3].corner[1]); });
  EXPECT_EQ(std::ranges::count(found, kVertices), 1);
}

/// Five normals about an axis, symmetric, so that the hull begins with the one that stands out by
/// next to nothing: rounded to float it may turn right.
TEST(VerifySurface, Hulls_have_no_flat_corners) {
  const double least = std::sqrt(2 * (1 - image::kEqualNormalCos));
  const auto unit = [](Vec3d v) { return (1 / norm(v)) * v; };
  for (int turn = 0; turn < 100; ++turn) {
    const Vec3d axis = unit({std::cos(turn), std::sin(turn), 0.1 * turn});
    const Vec3d u = across(axis);
    const Vec3d v = cross(axis, u);
    std::vector<Vec3d> normals;
    for (const auto& [x, y] : {std::pair(-0.3, -0.2), std::pair(-0.3 - 1e-9, 0.0),
                               std::pair(-0.3, 0.2), std::pair(0.3, -0.2), std::pair(0.3, 0.2)}) {
      normals.push_back(unit(axis + x * u + y * v));
    }
    const std::vector<Vec3d> hull = bake::spherical_hull(normals);
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Vec3d& next = hull[(i + 1) % hull.size()];
      const Vec3d& after = hull[(i + 2) % hull.size()];
      EXPECT_GT(dot(after, unit(cross(hull[i], next))), 0.1 * least) << "turn " << turn;
    }
  }
}

TEST(VerifySurface, Turned_corner_of_a_hull_is_found) {
  EXPECT_EQ(failures_after(
                [](const Records& r) { turn(r.normals[with_hull(r).first_normal].xyz, 1e-6); }),
            Names{kHulls});
}

TEST(VerifySurface, Hull_that_turns_right_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) {
              const auto& v = with_hull(r);
              std::swap(r.normals[v.first_normal], r.normals[v.first_normal + 1]);
            }),
            Names{kHulls});
}

/// The last corner of the hull counts as a concave normal instead.
TEST(VerifySurface, Hull_without_a_normal_is_found) {
  const auto found = failures_after([](const Records& r) {
    auto& v = with_hull(r);
    --v.hull_normals;
    ++v.concave_normals;
  });
  EXPECT_EQ(std::ranges::count(found, kHulls), 1);
}

TEST(VerifySurface, Hull_left_out_is_found) {
  const auto found = failures_after([](const Records& r) {
    auto& v = with_hull(r);
    v.concave_normals = static_cast<std::uint16_t>(v.concave_normals + v.hull_normals);
    v.hull_normals = 0;
  });
  EXPECT_EQ(std::ranges::count(found, kHulls), 1);
}

TEST(VerifySurface, Turned_pseudonormal_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) { turn(r.vertices[11].pseudonormal, 1e-6); }),
            Names{kPseudonormals});
}

TEST(VerifySurface, Missing_pseudonormal_is_found) {
  EXPECT_EQ(failures_after(
                [](const Records& r) { std::ranges::fill(r.vertices[11].pseudonormal, 0.0f); }),
            Names{kPseudonormals});
}

TEST(VerifySurface, Pseudonormal_on_a_border_is_found) {
  const BakedBody body(bowl(8, 12, 1), bake::ForEngine::regions);
  const Records r(body.view);
  const auto is_zero = [](const image::SurfaceVertex& v) {
    return vec3d(v.pseudonormal) == Vec3d{};
  };
  const auto border = std::ranges::find_if(r.vertices, is_zero);
  ASSERT_NE(border, r.vertices.end());
  border->pseudonormal[2] = 1;
  EXPECT_EQ(failures(body.view), Names{kPseudonormals});
}

TEST(VerifySurface, Turned_concave_normal_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) {
              const auto& v = with_concave(r);
              turn(r.normals[v.first_normal + v.hull_normals].xyz, 1e-6);
            }),
            Names{kConcave});
}

TEST(VerifySurface, Concave_normal_that_is_there_twice_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) {
              const auto& v = with_concave(r);
              const auto concave = r.normals.subspan(v.first_normal + v.hull_normals);
              concave[1] = concave[0];
            }),
            Names{kConcave});
}

TEST(VerifySurface, Edge_that_is_not_convex_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) {
              r.edges[0] = r.edges[0] % 3 == 2 ? r.edges[0] - 1 : r.edges[0] + 1;
            }),
            Names{kEdges});
}

TEST(VerifySurface, Edge_in_another_run_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) {
              image::SurfaceRun* run = run_with(r, &image::SurfaceRun::edges);
              --run[0].edges;
              --run[1].first_edge;
              ++run[1].edges;
            }),
            Names{kEdges});
}

TEST(VerifySurface, Cone_that_is_too_narrow_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) { r.runs[2].normal_cos += 2e-6f; }), Names{kCones});
}

TEST(VerifySurface, Cone_that_is_too_wide_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) { r.runs[2].normal_cos -= 1e-6f; }), Names{kCones});
}

TEST(VerifySurface, Cone_left_out_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) {
              std::ranges::fill(r.runs[2].normal, 0.0f);
              r.runs[2].normal_cos = -1;
            }),
            Names{kCones});
}

TEST(VerifySurface, Cell_that_names_a_far_triangle_is_found) {
  const auto far = [](const Records& r) {
    r.cells[5] = (r.cells[5] + static_cast<std::uint32_t>(r.triangles.size() / 2)) %
                 static_cast<std::uint32_t>(r.triangles.size());
  };
  EXPECT_EQ(failures_after(far), Names{kCells});
}

TEST(VerifySurface, Brick_that_names_a_far_triangle_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) {
              const auto coarse = std::ranges::find_if(
                  r.bricks, [](std::uint32_t b) { return (b & image::kCoarseBrick) != 0; });
              ASSERT_NE(coarse, r.bricks.end());
              const auto last = static_cast<std::uint32_t>(r.triangles.size() - 1);
              *coarse = image::kCoarseBrick | (last - (*coarse & ~image::kCoarseBrick));
            }),
            Names{kCells});
}

TEST(VerifySurface, Grid_that_does_not_hold_the_surface_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) { r.grid->origin[1] += 1; }), Names{kCells});
}

TEST(VerifySurface, Grid_of_other_cells_is_found) {
  EXPECT_EQ(failures_after([](const Records& r) { r.grid->cell *= 1.02f; }), Names{kCells});
}

}  // namespace
}  // namespace palpate::test

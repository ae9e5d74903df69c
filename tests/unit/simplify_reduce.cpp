// SPDX-License-Identifier: GPL-3.0-or-later
// Detail left out before baking: what is left is near, sound and coarser.
#include "host_bake/simplify/reduce.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "host_bake/metrics/nearest_on_triangle.hpp"
#include "host_bake/metrics/vector.hpp"
#include "host_bake/models/models.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::bake {
namespace {

/// What proofs give away: a tenth of the distance, or 1e-6.
constexpr double kExcess = 1.1;
constexpr double kRounding = 1e-6;

struct ReducedCase {
  NormalMesh before;
  CheckReport check;
  Reduced after;
};

ReducedCase reduced(const Mesh& mesh, double max_deviation) {
  ReducedCase c{.before = normalise(mesh), .check = check(mesh), .after = {}};
  c.after = reduce(c.before, c.check, max_deviation, {});
  return c;
}

double distance_to(const NormalMesh& mesh, Vec3d p) {
  double squared = std::numeric_limits<double>::infinity();
  for (const Face& f : mesh.faces) {
    const Vec3d on = nearest_on_triangle(p, vec(mesh.points[f[0]]), vec(mesh.points[f[1]]),
                                         vec(mesh.points[f[2]]));
    squared = std::min(squared, squared_norm(p - on));
  }
  return std::sqrt(squared);
}

/// Of corners, middles of edges and centres from the other surface, every triangle of it tried;
/// every seventh triangle.
double farthest_sample(const NormalMesh& of, const NormalMesh& from) {
  double farthest = 0;
  for (std::size_t face = 0; face < of.faces.size(); face += 7) {
    const Face& f = of.faces[face];
    const Vec3d c[3] = {vec(of.points[f[0]]), vec(of.points[f[1]]), vec(of.points[f[2]])};
    for (std::size_t i = 0; i < 3; ++i) {
      farthest = std::max(farthest, distance_to(from, c[i]));
      farthest = std::max(farthest, distance_to(from, 0.5 * (c[i] + c[(i + 1) % 3])));
    }
    farthest = std::max(farthest, distance_to(from, (1.0 / 3) * (c[0] + c[1] + c[2])));
  }
  return farthest;
}

TEST(Reduce, Both_surfaces_stay_near_one_another) {
  for (const auto& [name, triangles] :
       {std::pair{"golf_ball", 4000u}, std::pair{"jaw_lower", 3000u}, std::pair{"screw", 3000u}}) {
    for (const double most : {0.002, 0.01}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(most));
      const ReducedCase c = reduced(make_model(name, triangles), most);
      EXPECT_LT(c.after.mesh.faces.size(), c.before.faces.size());
      EXPECT_LE(double(c.after.deviation), most);
      const double to = farthest_sample(c.after.mesh, c.before);
      const double from = farthest_sample(c.before, c.after.mesh);
      EXPECT_LE(std::max(to, from), double(c.after.deviation));
      EXPECT_GE(kExcess * std::max(to, from) + kRounding, 0.5 * double(c.after.deviation));
      EXPECT_GE(double(c.after.deviation), 0.3 * most);
    }
  }
}

TEST(Reduce, More_deviation_leaves_fewer_triangles) {
  std::size_t last = std::numeric_limits<std::size_t>::max();
  for (const double most : {0.0005, 0.002, 0.008, 0.03}) {
    const ReducedCase c = reduced(make_model("golf_ball", 8000), most);
    EXPECT_LT(c.after.mesh.faces.size(), last);
    last = c.after.mesh.faces.size();
  }
}

TEST(Reduce, Flat_faces_need_few_triangles) {
  const ReducedCase c = reduced(test::quartered(test::box(0.02, 0.03, 0.05), 4), 1e-4);
  EXPECT_EQ(c.before.faces.size(), 12u * 256);
  EXPECT_EQ(c.after.mesh.faces.size(), 12u);
  EXPECT_LE(double(c.after.deviation), kRounding);
}

TEST(Reduce, Frame_and_soundness_are_kept) {
  const Mesh mesh = make_model("ball_joint_head", 5000);
  const ReducedCase c = reduced(mesh, 0.005);
  EXPECT_EQ(c.after.mesh.centre_m, c.before.centre_m);
  EXPECT_EQ(c.after.mesh.radius_m, c.before.radius_m);
  EXPECT_TRUE(c.after.check.bakeable());
  EXPECT_EQ(c.after.check.faces, c.after.mesh.faces.size());
  EXPECT_EQ(c.after.check.boundary_edges, 0u);
  EXPECT_EQ(c.after.check.crossings, 0u);
}

TEST(Reduce, Borders_of_open_surfaces_stay_where_they_are) {
  const ReducedCase c = reduced(test::bowl(24, 48, 0.05), 0.003);
  EXPECT_LT(c.after.mesh.faces.size(), c.before.faces.size() / 2);
  EXPECT_GT(c.after.check.boundary_edges, 0u);
  EXPECT_EQ(c.after.check.components, 1u);
  EXPECT_EQ(c.after.check.closed_components, 0u);
}

// Two bumpy balls, one in the other, nearer to each other than what may be left out.
TEST(Reduce, Surfaces_that_nearly_touch_do_not_cross) {
  Mesh mesh = test::bumpy_ball(30, 60, 0.05);
  Mesh within = test::scaled(test::bumpy_ball(30, 60, 0.05), 0.99);
  for (Face& f : within.faces) std::swap(f[1], f[2]);  // a room in a solid
  test::append(mesh, within, 0, 0, 0);
  const ReducedCase c = reduced(mesh, 0.05);
  EXPECT_EQ(c.check.crossings, 0u);
  EXPECT_EQ(c.after.check.crossings, 0u);
  EXPECT_EQ(c.after.check.components, 2u);
  EXPECT_LE(double(c.after.deviation), 0.05);
}

TEST(Reduce, Where_nothing_can_be_left_out_the_mesh_stays_itself) {
  const ReducedCase c = reduced(test::box(0.02, 0.03, 0.05), 1e-3);
  EXPECT_EQ(c.after.mesh.points, c.before.points);
  EXPECT_EQ(c.after.mesh.faces, c.before.faces);
  EXPECT_EQ(c.after.deviation, 0);
}

TEST(Reduce, Number_of_threads_does_not_matter) {
  const Mesh mesh = make_model("jaw_upper", 5000);
  const ReducedCase all = reduced(mesh, 0.004);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const ReducedCase alone = reduced(mesh, 0.004);
  EXPECT_EQ(all.after.mesh.points, alone.after.mesh.points);
  EXPECT_EQ(all.after.mesh.faces, alone.after.mesh.faces);
  EXPECT_EQ(all.after.deviation, alone.after.deviation);
}

}  // namespace
}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
// Each test of the constraints on a case made for it.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "decompose_shapes.hpp"
#include "host_bake/simplify/constraints.hpp"
#include "host_bake/simplify/patch_lists.hpp"
#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {
namespace {

using namespace test;

/// A surface with patches given by face, and a collapse begun.
struct Case {
  Surface surface;
  PatchLists patches;
  Constraints constraints;
  Ring ring;

  Case(const NormalMesh& mesh, const std::vector<Patch>& initial)
      : surface(mesh), patches(surface, initial), constraints(surface, patches) {}

  /// Begins with the edge from one vertex to another.
  void begin(std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t h = 0; h < surface.twin.size(); ++h)
      if (surface.start(h) == from && surface.end(h) == to) {
        ASSERT_TRUE(surface.find_ring(h, ring));
        constraints.begin(ring);
        return;
      }
    FAIL() << "no such edge";
  }
};

std::vector<Patch> each_face_alone(const NormalMesh& mesh) {
  std::vector<Patch> patches(mesh.faces.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) patches[f].faces = {f};
  return patches;
}

/// A square of eight faces about vertex 0 in the plane z = 0, with its corners and sides 1 to 8
/// counter-clockwise, and a closed body beside or above it.
NormalMesh square_and(const Mesh& body) {
  NormalMesh mesh = as_is(body);
  NormalMesh both;
  both.radius_m = 1;
  both.points = {{0, 0, 0},  {1, 0, 0},   {1, 1, 0},  {0, 1, 0}, {-1, 1, 0},
                 {-1, 0, 0}, {-1, -1, 0}, {0, -1, 0}, {1, -1, 0}};
  for (std::uint32_t i = 1; i <= 8; ++i) both.faces.push_back({0, i, i % 8 + 1});
  for (const auto& p : mesh.points) both.points.push_back(p);
  for (const Face& f : mesh.faces) both.faces.push_back({f[0] + 9, f[1] + 9, f[2] + 9});
  return both;
}

Mesh small_body(double height) {
  Mesh body = sphere(1);
  for (Point& p : body.points)
    for (std::size_t i = 0; i < 3; ++i) p[i] = 0.05 * p[i] + (i == 2 ? height : 0.2);
  return body;
}

std::vector<Patch> square_as_one_patch(const NormalMesh& mesh) {
  std::vector<Patch> patches(2);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) patches[f < 8 ? 0 : 1].faces.push_back(f);
  return patches;
}

TEST(Constraints, a_vertex_of_a_plane_may_stay_in_it) {
  const NormalMesh mesh = square_and(small_body(0.2));
  Case c(mesh, square_as_one_patch(mesh));
  c.begin(0, 1);
  EXPECT_EQ(c.constraints.judge({1, 0, 0}), Refusal::none);
}

TEST(Constraints, a_face_that_turns_over_or_loses_its_area_is_refused) {
  const NormalMesh mesh = square_and(small_body(0.2));
  Case c(mesh, each_face_alone(mesh));
  c.begin(0, 1);
  EXPECT_EQ(c.constraints.judge({3, 3, 0}), Refusal::flip);
  EXPECT_EQ(c.constraints.judge({1, 1, 0}), Refusal::flip);
}

TEST(Constraints, a_reflex_edge_inside_a_patch_is_refused) {
  const NormalMesh mesh = square_and(small_body(0.2));
  Case c(mesh, square_as_one_patch(mesh));
  c.begin(0, 5);
  EXPECT_EQ(c.constraints.judge({-1, 0, -0.1F}), Refusal::rounding);
}

TEST(Constraints, a_hull_that_would_swallow_a_body_is_refused) {
  const NormalMesh mesh = square_and(small_body(0.2));
  Case c(mesh, square_as_one_patch(mesh));
  c.begin(0, 3);
  // A tent over the body: convex itself, but the body enters its hull.
  const Refusal refusal = c.constraints.judge({0.2F, 0.3F, 0.9F});
  EXPECT_TRUE(refusal == Refusal::hull || refusal == Refusal::visibility) << name_of(refusal);
}

TEST(Constraints, a_face_that_crosses_another_is_refused) {
  const NormalMesh mesh = square_and(small_body(0.2));
  Case c(mesh, each_face_alone(mesh));
  c.begin(0, 3);
  EXPECT_EQ(c.constraints.judge({0.2F, 0.4F, 0.2F}), Refusal::crossing);
}

TEST(Constraints, a_face_that_enters_the_hull_of_another_patch_is_refused) {
  // The body without its lower half: its hull has a virtual face that a tip can pass.
  Mesh body = small_body(0.2);
  std::erase_if(body.faces, [&](const Face& f) {
    return body.points[f[0]][2] < 0.199 || body.points[f[1]][2] < 0.199 ||
           body.points[f[2]][2] < 0.199;
  });
  const NormalMesh mesh = square_and(body);
  std::vector<Patch> patches = each_face_alone(mesh);
  patches.resize(9);
  patches[8].faces.clear();
  for (std::uint32_t f = 8; f < mesh.faces.size(); ++f) patches[8].faces.push_back(f);
  Case c(mesh, patches);
  c.begin(0, 3);
  EXPECT_EQ(c.constraints.judge({0.2F, 0.2F, 0.21F}), Refusal::other_hull);
  EXPECT_EQ(c.constraints.judge({0.2F, 0.2F, 0.19F}), Refusal::none);
}

}  // namespace
}  // namespace palpate::bake

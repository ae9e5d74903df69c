// SPDX-License-Identifier: GPL-3.0-or-later
// verify() accepts good images and finds each planted violation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bake_support.hpp"

namespace palpate::bake {
namespace {

using testing::bake_bytes;
using testing::Image;

template <class T>
std::span<T> writable(std::span<const T> records) {
  return {const_cast<T*>(records.data()), records.size()};
}

// The image's records, which are in memory of the test's own.
struct Records {
  explicit Records(const ImageView& view)
      : levels(writable(view.levels)),
        pieces(writable(view.pieces)),
        vertices(writable(view.vertices)),
        neighbours(writable(view.neighbours)),
        triangles(writable(view.triangles)),
        virtual_faces(writable(view.virtual_faces)),
        culling_vertices(writable(view.culling_vertices)) {}
  std::span<image::Level> levels;
  std::span<image::Piece> pieces;
  std::span<image::Vertex> vertices;
  std::span<std::uint32_t> neighbours;
  std::span<image::Triangle> triangles;
  std::span<image::VirtualFace> virtual_faces;
  std::span<image::Vertex> culling_vertices;
};

std::string text_of(const std::vector<Proof>& proofs) {
  std::string text;
  for (const Proof& p : proofs) {
    if (!p.holds) text += p.invariant + ": " + p.found + "\n";
  }
  return text;
}

void expect_verified(const Mesh& mesh) {
  const Image image(bake_bytes(mesh));
  const std::vector<Proof> proofs = verify(image.view);
  EXPECT_GE(proofs.size(), 15u);
  EXPECT_EQ(text_of(proofs), "");
}

// What fails after an edit of the records.
template <class Edit>
std::string found_after(const Mesh& mesh, Edit edit) {
  const Image image(bake_bytes(mesh));
  edit(Records(image.view));
  return text_of(verify(image.view));
}

void scale(image::Vertex& v, float factor) {
  for (float& c : v.position) c *= factor;
}

#define EXPECT_FOUND(text, invariant) EXPECT_NE((text).find(invariant), std::string::npos) << (text)

TEST(Verify, Good_images_hold) {
  expect_verified({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  expect_verified(testing::cube());
  expect_verified(testing::sphere());
  expect_verified(testing::sheet(5));
  expect_verified(testing::two_spheres());
  expect_verified(testing::dented_sphere());
  expect_verified(testing::dented_sphere(4));
}

TEST(Verify, Doubled_source_triangle_is_found) {
  EXPECT_FOUND(found_after(testing::sphere(),
                           [](const Records& r) { r.triangles[3].source = r.triangles[4].source; }),
               "every source triangle");
}

TEST(Verify, Source_out_of_range_is_found) {
  EXPECT_FOUND(
      found_after(testing::sphere(), [](const Records& r) { r.triangles[3].source = 1u << 20; }),
      "every source triangle");
}

TEST(Verify, Dented_patch_is_found) {
  const std::string text =
      found_after(testing::sphere(), [](const Records& r) { scale(r.vertices[5], 0.8f); });
  EXPECT_FOUND(text, "no interior edge");
  EXPECT_FOUND(text, "no vertex is visible");
  EXPECT_FOUND(text, "hull vertices are the extreme points");
}

TEST(Verify, Turned_triangle_is_found) {
  EXPECT_FOUND(found_after(testing::sphere(),
                           [](const Records& r) {
                             std::swap(r.triangles[0].vertices[0], r.triangles[0].vertices[1]);
                           }),
               "no interior edge");
}

TEST(Verify, Patch_inside_another_hull_is_found) {
  const std::string text = found_after(testing::two_spheres(), [](const Records& r) {
    const image::Piece &a = r.pieces[1], &b = r.pieces[2];
    ASSERT_EQ(a.vertices, b.vertices);
    for (std::uint32_t i = 0; i < a.vertices; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        float& moved = r.vertices[b.first_vertex + i].position[c];
        moved = 0.5f * (moved + r.vertices[a.first_vertex + i].position[c]);
      }
    }
  });
  EXPECT_FOUND(text, "no triangle of a level enters");
}

TEST(Verify, Missing_virtual_face_is_found) {
  EXPECT_FOUND(found_after(testing::dented_sphere(),
                           [](const Records& r) {
                             ASSERT_FALSE(r.virtual_faces.empty());
                             r.virtual_faces[0].vertices[1] = r.virtual_faces[0].vertices[0];
                           }),
               "cover the hull");
}

TEST(Verify, Wrong_neighbour_is_found) {
  EXPECT_FOUND(found_after(testing::sphere(), [](const Records& r) { r.neighbours[0] = 60; }),
               "neighbours are");
}

TEST(Verify, Small_sphere_is_found) {
  EXPECT_FOUND(
      found_after(testing::dented_sphere(), [](const Records& r) { r.pieces[7].radius *= 0.999f; }),
      "spheres contain");
}

// A vertex of a leaf that is a corner of the root's hull too moves outward by one part in a
// million.
TEST(Verify, Child_outside_its_parent_is_found) {
  EXPECT_FOUND(found_after(testing::dented_sphere(),
                           [](const Records& r) {
                             const image::Vertex corner = r.vertices[r.pieces[0].first_vertex];
                             for (std::size_t i = r.pieces.size(); i-- > 0;) {
                               const auto run = r.vertices.subspan(r.pieces[i].first_vertex,
                                                                   r.pieces[i].hull_vertices);
                               for (image::Vertex& v : run) {
                                 if (!std::equal(v.position, v.position + 3, corner.position))
                                   continue;
                                 return scale(v, 1.000001f);
                               }
                             }
                             FAIL();
                           }),
               "hulls of free levels enclose");
}

// The first piece of a simplified level.
image::Piece& simplified_piece(const Records& r) {
  const auto found = std::find_if(r.pieces.begin(), r.pieces.end(), [&](const image::Piece& p) {
    return p.level > 0 && r.levels[p.level].free == 0 && p.hausdorff > 0 && p.culling_vertices > 0;
  });
  EXPECT_NE(found, r.pieces.end());
  return *found;
}

Mesh fine_dents() { return testing::dented_sphere(4); }

TEST(Verify, Too_small_h_is_found) {
  EXPECT_FOUND(
      found_after(fine_dents(), [](const Records& r) { simplified_piece(r).hausdorff = 0; }),
      "h and residual bound");
}

TEST(Verify, Too_small_culling_hull_is_found) {
  EXPECT_FOUND(found_after(fine_dents(),
                           [](const Records& r) {
                             const image::Piece& piece = simplified_piece(r);
                             for (std::uint32_t i = 0; i < piece.culling_vertices; ++i)
                               scale(r.culling_vertices[piece.first_culling_vertex + i], 0.99f);
                           }),
               "h and residual bound");
}

TEST(Verify, Too_small_s_is_found) {
  EXPECT_FOUND(found_after(fine_dents(),
                           [](const Records& r) {
                             for (image::Piece& p : r.pieces) p.surface_deviation = 0;
                           }),
               "s bounds how far");
}

TEST(Verify, Level_that_is_no_surface_is_found) {
  EXPECT_FOUND(found_after(fine_dents(),
                           [](const Records& r) {
                             const image::Piece& piece = simplified_piece(r);
                             auto& corners = r.triangles[piece.first_triangle].vertices;
                             std::swap(corners[0], corners[1]);
                           }),
               "levels are oriented manifolds");
}

TEST(Verify, Deviation_of_the_original_surface_is_found) {
  EXPECT_FOUND(
      found_after(testing::cube(),
                  [](const Records& r) { r.pieces[r.pieces.size() - 1].surface_deviation = 0.1f; }),
      "s is 0 on the original");
}

TEST(Verify, Resolution_out_of_order_is_found) {
  EXPECT_FOUND(
      found_after(testing::dented_sphere(), [](const Records& r) { r.levels[0].resolution = 0; }),
      "r is positive");
  EXPECT_FOUND(
      found_after(testing::dented_sphere(), [](const Records& r) { r.pieces[1].resolution = 5; }),
      "r is positive");
}

TEST(Verify, Support_area_of_zero_is_found) {
  EXPECT_FOUND(
      found_after(testing::cube(), [](const Records& r) { r.vertices[2].support_area = 0; }),
      "D is positive");
}

}  // namespace
}  // namespace palpate::bake

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "../support/tiny_image.hpp"
#include "../support/walk_image.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::test {
namespace {

using image::kNone;

std::vector<Part> row_of_boxes(unsigned count) {
  std::vector<Part> parts;
  for (unsigned i = 0; i < count; ++i) {
    const float x = -0.8f + 1.6f * static_cast<float>(i) / static_cast<float>(count);
    parts.push_back(box_part({x, 0, 0}, {0.1f, 0.2f, 0.3f}));
  }
  return parts;
}

/// Every kind of record: a flat leaf, one with a virtual face, one with adjacency, free levels.
ImageParts rich_parts() {
  return parts_of({tetrahedron_part(), triangle_part({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}),
                   ball_part(0.5f, 5, 8)});
}

Status status_of(const AlignedBytes& bytes) {
  ImageView view;
  return validate(bytes, view);
}

/// The status after a change to the parts of the rich image; the hash is right.
Status status_with(const std::function<void(ImageParts&)>& spoil) {
  ImageParts parts = rich_parts();
  spoil(parts);
  return status_of(seal(parts));
}

/// The status after a change to the sealed header; the hash is made right again.
Status status_with_header(const std::function<void(image::Header&)>& spoil) {
  AlignedBytes bytes = seal(rich_parts());
  image::Header header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  spoil(header);
  std::memcpy(bytes.data(), &header, sizeof(header));
  rehash(bytes);
  return status_of(bytes);
}

TEST(Validate, SoundImages_are_accepted_and_walkable) {
  const std::vector<std::vector<Part>> cases = {
      {tetrahedron_part()},
      {triangle_part({0, 0, 0}, {1, 0, 0}, {0, 1, 0})},
      {ball_part(1.0f, 5, 8)},
      row_of_boxes(2),
      row_of_boxes(7),
      row_of_boxes(100),
      {tetrahedron_part(), triangle_part({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}),
       ball_part(0.5f, 5, 8)}};
  for (const auto& leaves : cases) {
    const AlignedBytes bytes = seal(parts_of(leaves));
    ImageView view;
    ASSERT_EQ(validate(bytes, view), Status::ok);
    EXPECT_EQ(walk_image(view), "");
    EXPECT_EQ(view.header->leaf_pieces, leaves.size());
  }
}

TEST(Validate, View_points_into_the_bytes) {
  const ImageParts parts = rich_parts();
  const AlignedBytes bytes = seal(parts);
  ImageView view;
  ASSERT_EQ(validate(bytes, view), Status::ok);
  EXPECT_EQ(static_cast<const void*>(view.header), static_cast<const void*>(bytes.data()));
  EXPECT_EQ(view.levels.size(), parts.levels.size());
  EXPECT_EQ(view.pieces.size(), parts.pieces.size());
  EXPECT_EQ(view.vertices.size(), parts.vertices.size());
  EXPECT_EQ(view.neighbour_starts.size(), parts.neighbour_starts.size());
  EXPECT_EQ(view.neighbours.size(), parts.neighbours.size());
  EXPECT_EQ(view.triangles.size(), parts.triangles.size());
  EXPECT_EQ(view.virtual_faces.size(), parts.virtual_faces.size());
  EXPECT_EQ(std::memcmp(view.pieces.data(), parts.pieces.data(), view.pieces.size_bytes()), 0);
}

/// What it holds would be misread: it is to be baked anew.
TEST(Validate, Image_of_version_1_0_is_refused) {
  std::ifstream in(PALPATE_TEST_DATA "/image_1_0.bin", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  AlignedBytes bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  ImageView view;
  EXPECT_EQ(validate(bytes, view), Status::image_bad_version);
}

TEST(Validate, Refusal_leaves_the_view_alone) {
  AlignedBytes bytes = seal(rich_parts());
  bytes.back() = std::byte{1};
  ImageView view;
  EXPECT_EQ(validate(bytes, view), Status::image_bad_hash);
  EXPECT_EQ(view.header, nullptr);
}

TEST(Validate, Nothing_is_refused) {
  ImageView view;
  EXPECT_EQ(validate({}, view), Status::image_too_small);
}

TEST(Validate, EveryTruncation_is_refused) {
  const AlignedBytes bytes = seal(parts_of({tetrahedron_part()}));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const AlignedBytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_EQ(status_of(cut),
              n < sizeof(image::Header) ? Status::image_too_small : Status::image_bad_size);
  }
}

TEST(Validate, ExtraBytes_are_refused) {
  AlignedBytes bytes = seal(rich_parts());
  for (int i = 0; i < 65; ++i) {
    bytes.push_back(std::byte{0});
    EXPECT_EQ(status_of(bytes), Status::image_bad_size);
  }
}

TEST(Validate, EveryChangedByte_is_refused) {
  const AlignedBytes bytes = seal(parts_of({tetrahedron_part()}));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const std::byte change : {std::byte{1}, std::byte{0x80}, std::byte{0xff}}) {
      AlignedBytes changed = bytes;
      changed[i] ^= change;
      EXPECT_NE(status_of(changed), Status::ok) << "byte " << i;
    }
  }
}

TEST(Validate, Misalignment_is_refused) {
  const AlignedBytes bytes = seal(parts_of({tetrahedron_part()}));
  for (const std::size_t shift : {1u, 2u, 4u, 8u, 16u, 32u, 63u}) {
    AlignedBytes shifted(shift);
    shifted.insert(shifted.end(), bytes.begin(), bytes.end());
    ImageView view;
    EXPECT_EQ(validate(std::span(shifted).subspan(shift), view), Status::image_misaligned);
  }
}

TEST(Validate, Envelope_faults_have_their_names) {
  using H = image::Header;
  EXPECT_EQ(status_with_header([](H& h) { h.magic[0] = 'P'; }), Status::image_bad_magic);
  EXPECT_EQ(status_with_header([](H& h) { h.byte_order_mark = 0x04030201; }),
            Status::image_bad_byte_order);
  EXPECT_EQ(status_with_header([](H& h) { h.format_major = image::kFormatMajor + 1; }),
            Status::image_bad_version);
  EXPECT_EQ(status_with_header([](H& h) { h.format_major = 0; }), Status::image_bad_version);
  EXPECT_EQ(status_with_header([](H& h) { h.total_bytes += 64; }), Status::image_bad_size);
}

TEST(Validate, NewerMinorVersion_loads_and_its_unknown_parts_are_ignored) {
  using H = image::Header;
  EXPECT_EQ(status_with_header([](H& h) { h.format_minor = image::kFormatMinor + 1; }), Status::ok);
  EXPECT_EQ(status_with_header([](H& h) {
              h.format_minor = image::kFormatMinor + 1;
              h.reserved0 = h.reserved1 = 7;
              h.reserved2[23] = 1;
              h.flags |= 0x80000000u;
            }),
            Status::ok);
}

TEST(Validate, NewerMinorVersion_with_a_further_section_loads) {
  AlignedBytes bytes = seal(rich_parts());
  image::Header header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  header.sections[20] = {bytes.size(), 5, 12};
  bytes.resize(bytes.size() + 64);
  header.total_bytes = bytes.size();
  std::memcpy(bytes.data(), &header, sizeof(header));
  rehash(bytes);
  EXPECT_EQ(status_of(bytes), Status::image_bad_section);
  header.format_minor = image::kFormatMinor + 1;
  std::memcpy(bytes.data(), &header, sizeof(header));
  rehash(bytes);
  EXPECT_EQ(status_of(bytes), Status::ok);
}

TEST(Validate, HeaderFields_out_of_range_are_refused) {
  using H = image::Header;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::function<void(H&)>> changes = {
      [](H& h) { h.header_bytes = 575; },
      [](H& h) { h.flags = 16; },
      [](H& h) { h.flags = 2; },
      [](H& h) { h.flags = 4; },
      [](H& h) { h.source_boundary_edges = 1; },
      [](H& h) { h.source_crossings = 1; },
      [](H& h) { h.reserved0 = 1; },
      [](H& h) { h.reserved1 = 1; },
      [](H& h) { h.source_deviation_rel = -0.1f; },
      [](H& h) { h.source_deviation_rel = 4.1f; },
      [](H& h) { h.source_deviation_rel = kNanF; },
      [](H& h) { h.reserved2[0] = 1; },
      [](H& h) { h.centre_m[1] = kNan; },
      [](H& h) { h.centre_m[2] = 1e16; },
      [](H& h) { h.radius_m = 0; },
      [](H& h) { h.radius_m = -1; },
      [](H& h) { h.radius_m = kNan; },
      [](H& h) { h.radius_m = 1e13; },
      [](H& h) { h.source_triangles = 0; },
      [](H& h) { h.source_vertices = 0; },
      [](H& h) { h.source_components = 0; },
      [](H& h) { h.source_components = h.source_triangles + 1; },
      [](H& h) { h.delta_rel = kNanF; },
      [](H& h) { h.delta_rel = -0.1f; },
      [](H& h) { h.stop_resolution = kNanF; },
      [](H& h) { h.stop_deviation_rel = 5; },
      [](H& h) { h.s0_min = -1; },
      [](H& h) { h.partner_area = kNanF; },
      [](H& h) { ++h.tree_depth; },
      [](H& h) { --h.max_children; },
      [](H& h) { --h.max_hull_vertices; },
      [](H& h) { --h.max_patch_triangles; },
      [](H& h) { ++h.max_valence; },
      [](H& h) { ++h.leaf_pieces; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(status_with_header(changes[i]), Status::image_bad_header) << "change " << i;
  }
}

TEST(Validate, Sections_out_of_place_are_refused) {
  using H = image::Header;
  const std::vector<std::function<void(H&)>> changes = {
      [](H& h) { h.sections[0].offset += 64; },
      [](H& h) { h.sections[1].offset -= 64; },
      [](H& h) { h.sections[1].offset += 4; },
      [](H& h) { h.sections[1].offset = 0xffffffffffffffc0u; },
      [](H& h) { h.sections[2].count = 0xffffffffu; },
      [](H& h) { h.sections[2].stride = 32; },
      [](H& h) { h.sections[2].stride = 0; },
      [](H& h) { h.sections[3].count = 0; },
      [](H& h) { h.sections[3] = {}; },
      [](H& h) { h.sections[6].count += 64; },
      [](H& h) {
        h.sections[7] = {h.total_bytes - 64, 1, 4};
      },
      [](H& h) { h.sections[15].stride = 4; },
      [](H& h) { h.sections[15].offset = 64; },
      [](H& h) { std::swap(h.sections[0], h.sections[1]); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(status_with_header(changes[i]), Status::image_bad_section) << "change " << i;
  }
}

TEST(Validate, NonzeroPadding_is_refused) {
  AlignedBytes bytes = seal(parts_of({tetrahedron_part()}));
  bytes.back() = std::byte{1};
  rehash(bytes);
  EXPECT_EQ(status_of(bytes), Status::image_bad_section);
}

TEST(Validate, MissingSections_are_refused) {
  const auto empty = [](auto member) {
    return status_with([member](ImageParts& p) { (p.*member).clear(); });
  };
  EXPECT_EQ(empty(&ImageParts::levels), Status::image_missing_section);
  EXPECT_EQ(empty(&ImageParts::pieces), Status::image_missing_section);
  EXPECT_EQ(empty(&ImageParts::vertices), Status::image_missing_section);
  EXPECT_EQ(empty(&ImageParts::triangles), Status::image_missing_section);
}

TEST(Validate, Levels_that_contradict_their_pieces_are_refused) {
  using P = ImageParts;
  const std::vector<std::function<void(P&)>> changes = {
      [](P& p) { ++p.levels[0].pieces; },
      [](P& p) { ++p.levels[0].triangles; },
      [](P& p) { ++p.header.source_triangles; },
      [](P& p) { p.levels[1].triangles = 1; },
      [](P& p) { p.levels[0].free = 1; },
      [](P& p) { p.levels[1].free = 0; },
      [](P& p) { p.levels[1].free = 2; },
      [](P& p) { p.levels[1].reserved = 1; },
      [](P& p) { p.header.free_levels = 1; },
      [](P& p) { p.header.free_levels = 3; },
      [](P& p) { p.header.free_levels = 0xffffffffu; },
      [](P& p) { p.levels[0].max_surface_deviation_rel = 0.5f; },
      [](P& p) { p.levels[1].max_hausdorff_rel = 0.5f; },
      [](P& p) { p.levels[2].min_support_area_rel = 0.5f; },
      [](P& p) { p.pieces[0].hausdorff = p.pieces[0].culling_residual = 0.5f; },
      [](P& p) { p.levels[0].min_support_area_rel = std::numeric_limits<float>::quiet_NaN(); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(status_with(changes[i]), Status::image_bad_level) << "change " << i;
  }
}

/// Breadth first: 0 root, then the ball (a leaf) and the merged pair in some order, then two
/// leaves.
struct Roles {
  std::uint32_t pair, ball, tetrahedron, triangle;
};

Roles roles_of(const ImageParts& parts) {
  Roles roles{};
  for (std::uint32_t i = 1; i < parts.pieces.size(); ++i) {
    const image::Piece& p = parts.pieces[i];
    if (p.children > 0)
      roles.pair = i;
    else if (p.hull_vertices > image::kAdjacencyAbove)
      roles.ball = i;
    else
      (p.hull_vertices == 4 ? roles.tetrahedron : roles.triangle) = i;
  }
  return roles;
}

TEST(Validate, PieceRecords_that_are_inconsistent_are_refused) {
  using P = image::Piece;
  const Roles roles = roles_of(rich_parts());
  const auto status = [](std::uint32_t index, auto change) {
    return status_with([&](ImageParts& parts) { change(parts.pieces[index]); });
  };
  const auto bad = Status::image_bad_piece;
  EXPECT_EQ(status(1, [](P& p) { ++p.first_vertex; }), bad);
  EXPECT_EQ(status(1, [](P& p) { ++p.vertices; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.hull_vertices = 0; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.hull_vertices = 4; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.vertices = 0; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.vertices = 0xffffffffu; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.first_neighbour_start = 0; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.first_neighbour = 0; }), bad);
  EXPECT_EQ(status(roles.ball, [](P& p) { p.first_neighbour = kNone; }), bad);
  EXPECT_EQ(status(roles.ball, [](P& p) { p.first_neighbour_start = kNone; }), bad);
  EXPECT_EQ(status(roles.ball, [](P& p) { --p.hull_vertices; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { ++p.first_triangle; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.triangles = 0; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.triangles = 0xffffffffu; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.first_virtual_face = 0; }), bad);
  EXPECT_EQ(status(roles.tetrahedron, [](P& p) { p.first_virtual_face = 1; }), bad);
  EXPECT_EQ(status(roles.tetrahedron, [](P& p) { p.virtual_faces = 2; }), bad);
  EXPECT_EQ(status(roles.tetrahedron, [](P& p) { p.flags |= 1; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.flags = 0; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.flags |= 4; }), bad);
  EXPECT_EQ(status(roles.ball, [](P& p) { p.flags |= 2; }), bad);
  EXPECT_EQ(status(roles.triangle, [](P& p) { p.flags |= 2; }), Status::ok);
  EXPECT_EQ(status(0, [](P& p) { p.flags = 1; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.first_triangle = 0; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.reserved[2] = 1; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.level = 3; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.first_culling_vertex = 0; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.culling_vertices = 1; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.culling_vertices = 0xffffffffu; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.radius *= 0.99f; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.centre[0] += 0.1f; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.min_support_area = 0.125f; }), bad);
  EXPECT_EQ(status(0, [](P& p) { p.hull_vertices = image::kMaxHullVertices + 1; }),
            Status::image_over_limit);
}

TEST(Validate, PatchNormals_are_checked) {
  const Roles roles = roles_of(rich_parts());
  const auto status = [](std::uint32_t piece, float x, float cosine, auto also) {
    return status_with([&](ImageParts& p) {
      p.pieces[piece].patch_normal[0] = x;
      p.pieces[piece].patch_cosine = cosine;
      also(p);
    });
  };
  const auto nothing = [](ImageParts&) {};
  const Status bad = Status::image_bad_float;
  EXPECT_EQ(status(roles.triangle, 1, -1, nothing), Status::ok);
  EXPECT_EQ(status(roles.triangle, 1.1f, 1, nothing), bad);
  EXPECT_EQ(status(roles.triangle, std::numeric_limits<float>::quiet_NaN(), 1, nothing), bad);
  EXPECT_EQ(status(roles.triangle, 0.5f, 1.1f, nothing), bad);
  EXPECT_EQ(status(roles.triangle, 0, 0.5f, nothing), bad);  // of no normal
  EXPECT_EQ(status(0, 0.5f, 0.5f, nothing), bad);            // of no patch
  EXPECT_EQ(status(roles.triangle, 0.5f, 0.5f,
                   [&](ImageParts& p) { p.pieces[roles.triangle].patch_normal[1] = 0.9f; }),
            bad);
  EXPECT_EQ(status(roles.triangle, 0.5f, 0.5f,
                   [&](ImageParts& p) { p.pieces[roles.triangle].flags |= 2; }),
            bad);  // an open surface has no side
}

/// The root of rich_parts() with a culling hull: its own vertices.
ImageParts with_culling_hull() {
  ImageParts parts = rich_parts();
  image::Piece& root = parts.pieces[0];
  for (std::uint32_t i = 0; i < root.hull_vertices; ++i) {
    parts.culling_vertices.push_back(parts.vertices[root.first_vertex + i]);
    parts.culling_vertices.back().support_area = 0;
  }
  root.first_culling_vertex = 0;
  root.culling_vertices = root.hull_vertices;
  root.culling_residual = 0.25f;
  return parts;
}

Status status_of(const ImageParts& parts) {
  const AlignedBytes bytes = seal(parts);
  ImageView view;
  return validate(bytes, view);
}

TEST(Validate, CullingHulls_are_checked) {
  EXPECT_EQ(status_of(with_culling_hull()), Status::ok);
  const auto changed = [](auto change) {
    ImageParts parts = with_culling_hull();
    change(parts);
    return status_of(parts);
  };
  using P = ImageParts;
  EXPECT_EQ(changed([](P& p) { p.culling_vertices.pop_back(); }), Status::image_bad_piece);
  EXPECT_EQ(changed([](P& p) { p.culling_vertices.push_back(p.culling_vertices[0]); }),
            Status::image_bad_piece);
  EXPECT_EQ(changed([](P& p) { p.culling_vertices[3].position[0] = 2; }), Status::image_bad_float);
  EXPECT_EQ(changed([](P& p) { p.culling_vertices[3].support_area = 1; }), Status::image_bad_float);
  EXPECT_EQ(changed([](P& p) { p.pieces[0].culling_residual = -1; }), Status::image_bad_float);
  EXPECT_EQ(changed([](P& p) {
              for (float& c : p.culling_vertices[3].position) c *= 1.2f;
            }),
            Status::image_bad_piece);
}

TEST(Validate, Promise_of_an_image_is_checked) {
  using H = image::Header;
  const auto bad = Status::image_bad_header;
  EXPECT_EQ(status_with_header([](H& h) { h.dropped_levels = 1; }), bad);
  EXPECT_EQ(status_with_header([](H& h) { h.s0_min = 0.1f; }), bad);
  EXPECT_EQ(status_with_header([](H& h) { h.partner_area = 0.1f; }), bad);
  EXPECT_EQ(status_with_header([](H& h) { h.dropped_levels = 65; }), bad);
  // The original surface is said to be missing, but its triangles name their sources.
  EXPECT_EQ(status_with_header([](H& h) {
              h.dropped_levels = 1;
              h.s0_min = 0.1f;
            }),
            Status::image_bad_index);
}

TEST(Validate, PieceNumbers_out_of_range_are_refused) {
  using P = image::Piece;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float P::*const members[] = {&P::radius, &P::surface_deviation, &P::hausdorff, &P::resolution,
                               &P::min_support_area};
  for (const auto member : members) {
    for (const float value : {kNan, kInfinity, -kInfinity, -1.0f}) {
      EXPECT_EQ(status_with([&](ImageParts& p) { p.pieces[1].*member = value; }),
                Status::image_bad_float);
    }
  }
  for (const float value : {kNan, kInfinity, 1.6f, -1.6f}) {
    EXPECT_EQ(status_with([&](ImageParts& p) { p.pieces[1].centre[1] = value; }),
              Status::image_bad_float);
  }
  EXPECT_EQ(status_with([](ImageParts& p) { p.pieces[0].resolution = 1; }),
            Status::image_bad_float);
  EXPECT_EQ(status_with([](ImageParts& p) { p.pieces[1].min_support_area = 1e-40f; }),
            Status::image_bad_float);
  EXPECT_EQ(status_with([](ImageParts& p) { p.levels[1].resolution = 1; }),
            Status::image_bad_float);
  EXPECT_EQ(status_with([&](ImageParts& p) { p.levels[0].resolution = kInfinity; }),
            Status::image_bad_float);
}

TEST(Validate, Links_that_are_no_tree_are_refused) {
  using P = ImageParts;
  const Roles r = roles_of(rich_parts());
  const std::vector<std::function<void(P&)>> changes = {
      [](P& p) { p.pieces[0].parent = 0; },
      [](P& p) { p.pieces[0].parent = 1; },
      [](P& p) { p.pieces[1].parent = kNone; },
      [r](P& p) { p.pieces[r.tetrahedron].parent = 0; },
      [](P& p) { p.pieces[0].first_child = 0; },
      [](P& p) { p.pieces[0].first_child = 2; },
      [](P& p) { p.pieces[0].first_child = kNone; },
      [](P& p) { p.pieces[0].children = 1; },
      [](P& p) { p.pieces[0].children = 3; },
      [r](P& p) { p.pieces[r.pair].first_child = 1; },
      [r](P& p) { p.pieces[r.pair].first_child = r.pair; },
      [r](P& p) { p.pieces[r.triangle].first_child = 1; },
      [r](P& p) { p.pieces[r.triangle].children = 1; },
      [](P& p) {  // one more level above the root, which no longer is the last level's
        p.levels.push_back(p.levels.back());
        ++p.header.free_levels;
      }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(status_with(changes[i]), Status::image_bad_tree) << "change " << i;
  }
  EXPECT_EQ(status_with([](P& p) { p.pieces[0].children = image::kMaxChildren + 1; }),
            Status::image_over_limit);
}

TEST(Validate, PieceInTwoTrees_is_refused) {
  // A second root with a loop of its own: 3 and 4 would own one another.
  EXPECT_NE(status_with([](ImageParts& p) {
              p.pieces[3].parent = 4;
              p.pieces[4].parent = 3;
              p.pieces[3].first_child = 4;
              p.pieces[3].children = 1;
            }),
            Status::ok);
}

TEST(Validate, IndicesOutOfRange_are_refused) {
  using P = ImageParts;
  const std::vector<std::function<void(P&)>> changes = {
      [](P& p) { p.triangles[0].vertices[0] = 1000; },
      [](P& p) { p.triangles[0].vertices[0] = kNone; },
      [](P& p) { p.triangles[0].vertices[0] = p.triangles[0].vertices[1]; },
      [](P& p) { p.triangles[0].source = p.header.source_triangles; },
      [](P& p) { p.triangles[0].source = kNone; },
      [](P& p) { p.virtual_faces[0].vertices[2] = 4; },
      [](P& p) { p.virtual_faces[0].vertices[2] = p.virtual_faces[0].vertices[0]; },
      [](P& p) { p.neighbour_starts[0] = 1; },
      [](P& p) { p.neighbour_starts[1] = 0; },
      [](P& p) { p.neighbour_starts[1] = p.neighbour_starts[2]; },
      [](P& p) { p.neighbour_starts[1] = p.neighbour_starts[2] + 1; },
      [](P& p) { p.neighbour_starts[1] = kNone; },
      [](P& p) { p.neighbours[0] = 42; },
      [](P& p) { p.neighbours[0] = 0; },
      [](P& p) { p.neighbours[1] = p.neighbours[0]; },
      [](P& p) { std::swap(p.neighbours[0], p.neighbours[1]); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(status_with(changes[i]), Status::image_bad_index) << "change " << i;
  }
}

TEST(Validate, VertexNumbers_out_of_range_are_refused) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float value : {kNan, kInfinity, -kInfinity, 1.6f}) {
    EXPECT_EQ(status_with([&](ImageParts& p) { p.vertices[5].position[2] = value; }),
              Status::image_bad_float);
  }
  for (const float value : {kNan, kInfinity, 0.0f, -1.0f, 1e-40f, 1e10f}) {
    EXPECT_EQ(status_with([&](ImageParts& p) { p.vertices[5].support_area = value; }),
              Status::image_bad_float);
  }
}

TEST(Validate, MoreLevelsThanTheLimit_are_refused) {
  EXPECT_EQ(status_with([](ImageParts& p) {
              p.levels.resize(image::kMaxLevels + 1, p.levels.back());
              p.header.free_levels = image::kMaxLevels;
            }),
            Status::image_over_limit);
}

/// Every word of an image that holds every kind of record, replaced by every awkward value, with
/// the hash made right: refused, or as safe to walk as any other image.
TEST(Validate, EveryWordSpoilt_is_refused_or_harmless) {
  const AlignedBytes sound = seal(rich_parts());
  AlignedBytes bytes = sound;
  std::size_t accepted = 0;
  for (std::size_t at = 0; at < sound.size(); at += 4) {
    std::uint32_t old = 0;
    std::memcpy(&old, sound.data() + at, 4);
    for (const std::uint32_t value :
         {0u, 1u, 2u, old + 1, old - 1, old ^ 0x80000000u, old << 8, kNone, 0x7fffffffu,
          std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()),
          std::bit_cast<std::uint32_t>(0.5f), std::bit_cast<std::uint32_t>(1e-42f)}) {
      std::memcpy(bytes.data() + at, &value, 4);
      rehash(bytes);
      ImageView view;
      if (validate(bytes, view) != Status::ok) continue;
      ++accepted;
      ASSERT_EQ(walk_image(view), "") << "offset " << at << " value " << value;
    }
    std::memcpy(bytes.data() + at, sound.data() + at, 4);
  }
  EXPECT_GT(accepted, 0u);  // the source's hash, for one, is free
}

}  // namespace
}  // namespace palpate::test

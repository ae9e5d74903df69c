// SPDX-License-Identifier: Apache-2.0
// docs/FORMAT.md against rt_core/image/format.hpp: a reader written from the page reads the image.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "../support/temporary_folder.hpp"
#include "../support/tiny_image.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::test {
namespace {

struct Field {
  std::size_t offset;
  std::size_t bytes;
  std::string name;
  bool operator==(const Field&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Field& field) {
  return out << field.name << " at " << field.offset << ", " << field.bytes << " bytes";
}

std::string page() { return read_file(PALPATE_DOCS "/FORMAT.md"); }

/// The page from a heading to the next one.
std::string chapter(const std::string& heading) {
  const std::string text = page();
  const std::size_t start = text.find("\n" + heading + "\n");
  EXPECT_NE(start, std::string::npos) << heading;
  const std::size_t end = text.find("\n#", start + 1);
  return text.substr(start, end - start);
}

std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream in(row.substr(1));
  for (std::string cell; std::getline(in, cell, '|');) {
    const std::size_t first = cell.find_first_not_of(' ');
    const std::size_t last = cell.find_last_not_of(' ');
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

/// Rows of the tables below a heading whose first cell is a number.
std::vector<std::vector<std::string>> rows_of(const std::string& heading) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(chapter(heading));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| ")) continue;
    auto cells = cells_of(line);
    if (cells[0].find_first_not_of("0123456789") == std::string::npos) {
      rows.push_back(std::move(cells));
    }
  }
  return rows;
}

std::vector<Field> fields_of(const std::string& heading) {
  std::vector<Field> fields;
  for (const auto& row : rows_of(heading)) {
    if (row.size() != 6) continue;  // not a record's table
    fields.push_back({std::stoul(row[0]), std::stoul(row[1]), row[2]});
  }
  return fields;
}

// NOLINTNEXTLINE(bugprone-macro-parentheses): types and members
#define PALPATE_FIELD(type, member) \
  Field { offsetof(type, member), sizeof(type::member), #member }

TEST(FormatPage, Header_is_the_struct) {
  using H = image::Header;
  const std::vector<Field> expected = {PALPATE_FIELD(H, magic),
                                       PALPATE_FIELD(H, format_major),
                                       PALPATE_FIELD(H, format_minor),
                                       PALPATE_FIELD(H, byte_order_mark),
                                       PALPATE_FIELD(H, header_bytes),
                                       PALPATE_FIELD(H, flags),
                                       PALPATE_FIELD(H, total_bytes),
                                       PALPATE_FIELD(H, content_sha256),
                                       PALPATE_FIELD(H, source_sha256),
                                       PALPATE_FIELD(H, centre_m),
                                       PALPATE_FIELD(H, radius_m),
                                       PALPATE_FIELD(H, source_triangles),
                                       PALPATE_FIELD(H, source_vertices),
                                       PALPATE_FIELD(H, source_components),
                                       PALPATE_FIELD(H, source_boundary_edges),
                                       PALPATE_FIELD(H, source_crossings),
                                       PALPATE_FIELD(H, reserved0),
                                       PALPATE_FIELD(H, delta_rel),
                                       PALPATE_FIELD(H, stop_resolution),
                                       PALPATE_FIELD(H, stop_deviation_rel),
                                       PALPATE_FIELD(H, stop_pieces),
                                       PALPATE_FIELD(H, s0_min),
                                       PALPATE_FIELD(H, partner_area),
                                       PALPATE_FIELD(H, free_levels),
                                       PALPATE_FIELD(H, tree_depth),
                                       PALPATE_FIELD(H, max_children),
                                       PALPATE_FIELD(H, max_hull_vertices),
                                       PALPATE_FIELD(H, max_patch_triangles),
                                       PALPATE_FIELD(H, max_valence),
                                       PALPATE_FIELD(H, leaf_pieces),
                                       PALPATE_FIELD(H, dropped_levels),
                                       PALPATE_FIELD(H, source_deviation_rel),
                                       PALPATE_FIELD(H, reserved1),
                                       PALPATE_FIELD(H, sections),
                                       PALPATE_FIELD(H, reserved2)};
  EXPECT_EQ(fields_of("## 2. Header"), expected);
}

TEST(FormatPage, Section_and_its_slots_are_those_of_the_header) {
  using S = image::Section;
  const std::vector<Field> expected = {PALPATE_FIELD(S, offset), PALPATE_FIELD(S, count),
                                       PALPATE_FIELD(S, stride)};
  EXPECT_EQ(fields_of("## 3. Sections"), expected);
  const std::vector<std::size_t> strides = {
      sizeof(image::Level),           sizeof(image::Piece),  sizeof(image::Vertex),
      sizeof(std::uint32_t),          sizeof(std::uint32_t), sizeof(image::Triangle),
      sizeof(image::VirtualFace),     sizeof(image::Vertex), sizeof(image::RegionNode),
      sizeof(image::RegionTriangle),  sizeof(image::Region), sizeof(image::ProximityGrid),
      sizeof(std::uint32_t),          sizeof(std::uint32_t), sizeof(image::SurfaceVertex),
      sizeof(image::SurfaceNormal),   sizeof(std::uint32_t), sizeof(image::SurfaceRun),
      sizeof(image::TriangleVertices)};
  std::vector<std::size_t> found;
  for (const auto& row : rows_of("## 3. Sections")) {
    if (row.size() == 4) found.push_back(std::stoul(row[2]));
  }
  EXPECT_EQ(found, strides);
}

TEST(FormatPage, Regions_are_the_structs) {
  using N = image::RegionNode;
  const std::vector<Field> node = {
      PALPATE_FIELD(N, centre),  PALPATE_FIELD(N, axes),     PALPATE_FIELD(N, half),
      PALPATE_FIELD(N, first),   PALPATE_FIELD(N, children), PALPATE_FIELD(N, leaf),
      PALPATE_FIELD(N, parent),  PALPATE_FIELD(N, region),   PALPATE_FIELD(N, first_region),
      PALPATE_FIELD(N, regions), PALPATE_FIELD(N, reserved)};
  EXPECT_EQ(fields_of("### RegionNode"), node);
  using T = image::RegionTriangle;
  const std::vector<Field> triangle = {PALPATE_FIELD(T, corners), PALPATE_FIELD(T, neighbours),
                                       PALPATE_FIELD(T, region),  PALPATE_FIELD(T, piece),
                                       PALPATE_FIELD(T, source),  PALPATE_FIELD(T, component)};
  EXPECT_EQ(fields_of("### RegionTriangle"), triangle);
  using R = image::Region;
  const std::vector<Field> region = {PALPATE_FIELD(R, parent), PALPATE_FIELD(R, slot),
                                     PALPATE_FIELD(R, reach), PALPATE_FIELD(R, radius)};
  EXPECT_EQ(fields_of("### Region"), region);
}

TEST(FormatPage, Proximity_grid_is_the_struct) {
  using G = image::ProximityGrid;
  const std::vector<Field> grid = {PALPATE_FIELD(G, origin), PALPATE_FIELD(G, cell),
                                   PALPATE_FIELD(G, bricks), PALPATE_FIELD(G, reserved)};
  EXPECT_EQ(fields_of("### ProximityGrid"), grid);
}

TEST(FormatPage, Surface_is_the_structs) {
  using V = image::SurfaceVertex;
  const std::vector<Field> vertex = {PALPATE_FIELD(V, position), PALPATE_FIELD(V, pseudonormal),
                                     PALPATE_FIELD(V, first_normal), PALPATE_FIELD(V, hull_normals),
                                     PALPATE_FIELD(V, concave_normals)};
  EXPECT_EQ(fields_of("### SurfaceVertex"), vertex);
  using R = image::SurfaceRun;
  const std::vector<Field> run = {PALPATE_FIELD(R, first_vertex), PALPATE_FIELD(R, vertices),
                                  PALPATE_FIELD(R, first_edge),   PALPATE_FIELD(R, edges),
                                  PALPATE_FIELD(R, normal),       PALPATE_FIELD(R, normal_cos)};
  EXPECT_EQ(fields_of("### SurfaceRun"), run);
}

TEST(FormatPage, Level_is_the_struct) {
  using L = image::Level;
  const std::vector<Field> expected = {PALPATE_FIELD(L, pieces),
                                       PALPATE_FIELD(L, triangles),
                                       PALPATE_FIELD(L, free),
                                       PALPATE_FIELD(L, resolution),
                                       PALPATE_FIELD(L, max_surface_deviation_rel),
                                       PALPATE_FIELD(L, max_hausdorff_rel),
                                       PALPATE_FIELD(L, min_support_area_rel),
                                       PALPATE_FIELD(L, reserved)};
  EXPECT_EQ(fields_of("## 4. Level"), expected);
}

TEST(FormatPage, Piece_is_the_struct) {
  using P = image::Piece;
  const std::vector<Field> expected = {PALPATE_FIELD(P, centre),
                                       PALPATE_FIELD(P, radius),
                                       PALPATE_FIELD(P, first_vertex),
                                       PALPATE_FIELD(P, hull_vertices),
                                       PALPATE_FIELD(P, first_child),
                                       PALPATE_FIELD(P, children),
                                       PALPATE_FIELD(P, first_neighbour_start),
                                       PALPATE_FIELD(P, first_neighbour),
                                       PALPATE_FIELD(P, flags),
                                       PALPATE_FIELD(P, level),
                                       PALPATE_FIELD(P, surface_deviation),
                                       PALPATE_FIELD(P, hausdorff),
                                       PALPATE_FIELD(P, resolution),
                                       PALPATE_FIELD(P, min_support_area),
                                       PALPATE_FIELD(P, parent),
                                       PALPATE_FIELD(P, vertices),
                                       PALPATE_FIELD(P, first_triangle),
                                       PALPATE_FIELD(P, triangles),
                                       PALPATE_FIELD(P, first_virtual_face),
                                       PALPATE_FIELD(P, virtual_faces),
                                       PALPATE_FIELD(P, first_culling_vertex),
                                       PALPATE_FIELD(P, culling_vertices),
                                       PALPATE_FIELD(P, culling_residual),
                                       PALPATE_FIELD(P, patch_normal),
                                       PALPATE_FIELD(P, patch_cosine),
                                       PALPATE_FIELD(P, reserved)};
  EXPECT_EQ(fields_of("## 5. Piece"), expected);
}

TEST(FormatPage, Vertex_and_faces_are_the_structs) {
  const std::vector<Field> vertex = {PALPATE_FIELD(image::Vertex, position),
                                     PALPATE_FIELD(image::Vertex, support_area)};
  const std::vector<Field> triangle = {PALPATE_FIELD(image::Triangle, vertices),
                                       PALPATE_FIELD(image::Triangle, source)};
  const std::vector<Field> virtual_face = {PALPATE_FIELD(image::VirtualFace, vertices)};
  EXPECT_EQ(fields_of("## 6. Vertex"), vertex);
  EXPECT_EQ(fields_of("### Triangle"), triangle);
  EXPECT_EQ(fields_of("### VirtualFace"), virtual_face);
}

#undef PALPATE_FIELD

TEST(FormatPage, Limits_and_version_are_those_of_the_header) {
  const std::string text = page();
  const auto says = [&](const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << words;
  };
  says("at most " + std::to_string(image::kMaxLevels) + " levels, " +
       std::to_string(image::kMaxPieces) + " pieces, " + std::to_string(image::kMaxChildren) +
       " children and " + std::to_string(image::kMaxHullVertices) + " hull vertices");
  says("version " + std::to_string(image::kFormatMajor) + "." +
       std::to_string(image::kFormatMinor));
  says("at most " + std::to_string(image::kMaxOpenPatchTriangles) + " where back_open");
  says("Hulls of more than " + std::to_string(image::kAdjacencyAbove) + " vertices");
  says("1.17549435e-38 to 1e9");
  EXPECT_EQ(image::kMinArea, 1.17549435e-38f);
  EXPECT_EQ(image::kMaxArea, 1e9f);
  EXPECT_EQ(image::kMaxNorm, 1.5f);
  EXPECT_EQ(image::kMaxLength, 4.0f);
  EXPECT_EQ(image::kMinRadius_m, 1e-12);
  EXPECT_EQ(image::kMaxRadius_m, 1e12);
  EXPECT_EQ(image::kMaxCentre_m, 1e15);
}

/// What the page's reader prints for a level, computed here.
std::string expected_obj(const ImageParts& parts) {
  std::ostringstream out;
  std::size_t first = 1;
  for (const image::Piece& piece : parts.pieces) {
    if (piece.level != 0) continue;
    for (std::uint32_t i = 0; i < piece.vertices; ++i) {
      const image::Vertex& v = parts.vertices[piece.first_vertex + i];
      out << "v";
      for (std::size_t axis = 0; axis < 3; ++axis) {
        out << " "
            << parts.header.centre_m[axis] +
                   parts.header.radius_m * static_cast<double>(v.position[axis]);
      }
      out << "\n";
    }
    for (std::uint32_t i = 0; i < piece.triangles; ++i) {
      out << "f";
      for (const std::uint32_t v : parts.triangles[piece.first_triangle + i].vertices) {
        out << " " << first + v;
      }
      out << "\n";
    }
    first += piece.vertices;
  }
  return out.str();
}

TEST(FormatPage, Reader_on_the_page_reads_an_image) {
  if (std::system("python3 --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3";
  const std::string text = page();
  const std::size_t start = text.find("```python\n") + 10;
  const TemporaryFolder folder;
  folder.write("reader.py", text.substr(start, text.find("```", start) - start));

  // Coordinates that C++ and Python print alike.
  ImageParts parts =
      parts_of({tetrahedron_part(),
                triangle_part({0.25f, 0.75f, 0}, {0.5f, 0.25f, 0}, {0.125f, 0.5f, 0.5f})},
               0.5);
  parts.header.centre_m[1] = 8.5;
  const AlignedBytes bytes = seal(parts);
  folder.write("image.palp",
               {static_cast<const char*>(static_cast<const void*>(bytes.data())), bytes.size()});
  const std::string command =
      "cd '" + folder.path().string() + "' && python3 reader.py image.palp 0 > level.obj";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::string obj = read_file(folder.path() / "level.obj");
  for (std::size_t at = 0; (at = obj.find(".0", at)) != std::string::npos;) {
    const bool ends = at + 2 == obj.size() || obj[at + 2] == ' ' || obj[at + 2] == '\n';
    if (ends)
      obj.erase(at, 2);
    else
      ++at;
  }
  EXPECT_EQ(obj, expected_obj(parts));
}

}  // namespace
}  // namespace palpate::test

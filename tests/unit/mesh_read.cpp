// SPDX-License-Identifier: GPL-3.0-or-later
// Every format and variant that read_mesh() takes gives the same cube.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "host_bake/base/error.hpp"
#include "host_bake/mesh/check.hpp"
#include "mesh_support.hpp"

namespace palpate::bake::testing {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string upper(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

/// The corners of each face as positions, starting at the smallest, sorted: equal for equal
/// surfaces.
std::vector<std::array<Point, 3>> surface(const Mesh& mesh) {
  std::vector<std::array<Point, 3>> triangles;
  for (const Face& f : mesh.faces) {
    std::array<Point, 3> t = {mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

void expect_cube(const std::string& bytes, const std::string& extension) {
  SCOPED_TRACE(extension + ": " + bytes.substr(0, 40));
  const ReadMesh read = read_as(bytes, extension);
  EXPECT_EQ(surface(read.mesh), surface(cube()));
  EXPECT_EQ(read.mesh.points.size(), 8U);
}

TEST(Read, Obj_plain_is_read) { expect_cube(to_obj(cube()), ".obj"); }

TEST(Read, Obj_variants_are_read) {
  const std::string plain = to_obj(cube());
  expect_cube(replaced(plain, "\n", "\r\n"), ".obj");
  expect_cube(replaced(plain, " ", "\t"), ".obj");
  expect_cube(replaced(plain, "f ", "f \\\n"), ".obj");
  expect_cube(replaced(plain, "v 1", "v +1.0e0"), ".obj");
  expect_cube("# a comment\no thing\nusemtl none\nvn 0 0 1\nvt 0 0\n" + plain + "p 1 2\nl 1 2 3\n",
              ".obj");
  expect_cube("\xEF\xBB\xBF" + plain, ".obj");
  expect_cube(plain.substr(0, plain.size() - 1), ".obj");
  expect_cube(plain, ".txt");
  std::string slashes, negative;
  for (const Face& f : cube().faces) {
    slashes += "f";
    negative += "f";
    for (const std::uint32_t v : f) {
      slashes += " " + std::to_string(v + 1) + (v % 2 == 0 ? "/1/2" : "//3");
      negative += " " + std::to_string(static_cast<int>(v) - 8);
    }
    slashes += "\n";
    negative += " # back from the last\n";
  }
  expect_cube(plain.substr(0, plain.find('f')) + slashes, ".obj");
  expect_cube(plain.substr(0, plain.find('f')) + negative, ".obj");
}

TEST(Read, Off_plain_is_read) { expect_cube(to_off(cube()), ".off"); }

TEST(Read, Off_variants_are_read) {
  const std::string plain = to_off(cube());
  expect_cube(replaced(plain, "\n", "\r\n"), ".off");
  expect_cube(replaced(plain, "\n", " # why\n\n"), ".off");
  expect_cube("# first a comment\n" + plain, ".off");
  expect_cube(plain, ".txt");
  expect_cube(replaced(plain, "OFF\n", "OFF "), ".off");
  expect_cube(replaced(plain, "OFF\n", ""), ".off");
  expect_cube(replaced(plain, " 12 0\n", " 12\n"), ".off");
  expect_cube(replaced(replaced(plain, "\n", " 255 0 0\n"), "OFF 255 0 0\n", "COFF\n"), ".off");
  expect_cube(replaced(replaced(plain, "\n", " 0 0 1\n"), "OFF 0 0 1\n", "NOFF\n"), ".off");
  expect_cube(to_off_binary(cube()), ".off");
}

TEST(Read, Stl_plain_is_read) {
  expect_cube(to_stl_ascii(cube()), ".stl");
  expect_cube(to_stl_binary(cube()), ".stl");
}

TEST(Read, Stl_variants_are_read) {
  const std::string plain = to_stl_ascii(cube());
  expect_cube(upper(plain), ".stl");
  expect_cube(replaced(plain, "\n", "\r\n"), ".stl");
  expect_cube(replaced(plain, "\n", "\n\t  "), ".stl");
  expect_cube(replaced(plain, "solid of a test", "solid facet solid endsolid"), ".stl");
  expect_cube("solid nothing\nendsolid nothing\n" + plain, ".stl");
  expect_cube(plain, ".txt");
  expect_cube(to_stl_binary(cube(), "solid but binary"), ".stl");
  expect_cube(to_stl_binary(cube(), "ply"), ".stl");
  expect_cube(to_stl_binary(cube()), ".txt");
}

TEST(Read, Stl_of_exporters_that_end_a_solid_in_two_words_is_read) {
  const std::string plain = replaced(to_stl_ascii(cube()), "endsolid", "end solid");
  expect_cube(plain, ".stl");
  expect_cube(upper(plain), ".stl");
  expect_cube("solid nothing\nend solid nothing\n" + plain, ".stl");
  EXPECT_NE(refusal(replaced(plain, "end solid", "end\nsolid"), ".stl").find("'endsolid' missing"),
            std::string::npos);
}

TEST(Read, Lines_that_end_in_carriage_returns_alone_are_read) {
  for (const char* line_end : {"\r", "\r\n", "\r\r\n"}) {
    SCOPED_TRACE(line_end);
    const auto ended = [&](const std::string& text) { return replaced(text, "\n", line_end); };
    expect_cube(ended("# a comment\no thing\n" + to_obj(cube())), ".obj");
    expect_cube(ended(replaced(to_obj(cube()), "f ", "f \\\n")), ".obj");
    expect_cube(ended("# a comment\n" + to_off(cube())), ".off");
    expect_cube(ended(to_ply_ascii(cube())), ".ply");
    expect_cube(ended(to_stl_ascii(cube())), ".stl");
    const std::string stl = replaced(to_stl_ascii(cube()), "endsolid", "end solid");
    EXPECT_EQ(read_as(ended(stl + to_stl_ascii(cube({5, 0, 0}))), ".stl").mesh.faces.size(), 24U);
    EXPECT_NE(refusal(ended("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n"), ".obj").find(":4: "),
              std::string::npos);
  }
}

TEST(Read, Stl_several_solids_are_one_mesh) {
  const ReadMesh read = read_as(to_stl_ascii(cube()) + to_stl_ascii(cube({5, 0, 0})), ".stl");
  EXPECT_EQ(read.mesh.faces.size(), 24U);
  EXPECT_EQ(check(read.mesh).components, 2U);
}

TEST(Read, Ply_plain_is_read) {
  expect_cube(to_ply_ascii(cube()), ".ply");
  expect_cube(to_ply_binary(cube(), std::endian::little), ".ply");
  expect_cube(to_ply_binary(cube(), std::endian::big), ".ply");
}

TEST(Read, Ply_variants_are_read) {
  expect_cube(replaced(to_ply_ascii(cube()), "\n", "\r\n"), ".ply");
  expect_cube(to_ply_binary(cube(), std::endian::little, "\r\n"), ".ply");
  expect_cube(to_ply_binary(cube(), std::endian::little, "\r"), ".ply");
  expect_cube(to_ply_ascii(cube()), ".txt");
  // A data byte that looks like a line end right behind the header.
  for (const std::uint32_t bytes : {0x0A0A0A0AU, 0x0D0D0D0DU, 0x0D0D0A0DU}) {
    for (const char* line_end : {"\n", "\r\n", "\r"}) {
      Mesh mesh = cube();
      mesh.points[0][0] = static_cast<double>(std::bit_cast<float>(bytes));
      const std::string file = to_ply_binary(mesh, std::endian::little, line_end);
      EXPECT_EQ(surface(read_as(file, ".ply").mesh), surface(mesh)) << bytes;
    }
  }
}

/// A PLY with the given types, faces before vertices and an element that says nothing to us.
std::string odd_ply(const std::string& coordinate, const std::string& index) {
  std::string out =
      "ply\nformat ascii 1.0\nobj_info none\nelement camera 1\nproperty list int double k\n"
      "element face 12\nproperty uchar flags\nproperty list " +
      index + " " + index + " vertex_index\nelement vertex 8\n";
  for (const char axis : {'z', 'y', 'x'}) out += "property " + coordinate + " " + axis + "\n";
  out += "end_header\n3 1.5 2.5 3.5\n";
  for (const Face& f : cube().faces) {
    out += "0 3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) +
           "\n";
  }
  for (const Point& p : cube().points) {
    for (const std::size_t i : {2U, 1U, 0U}) out += std::to_string(static_cast<int>(p[i])) + " ";
  }
  return out;
}

TEST(Read, Ply_number_types_are_all_read) {
  for (const char* coordinate :
       {"char", "uint8", "short", "uint16", "int", "uint32", "float32", "double"}) {
    for (const char* index : {"int8", "uchar", "int16", "ushort", "int32", "uint"}) {
      expect_cube(odd_ply(coordinate, index), ".ply");
    }
  }
}

/// A tetrahedron as one strip: the triangles 0 1 2, 2 1 3, 2 3 0, 0 3 1.
std::string strips_ply(const std::string& lists) {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nelement tristrips " +
         std::to_string(std::ranges::count(lists, '\n')) +
         "\nproperty list int int vertex_indices\nend_header\n"
         "0 0 0\n0 1 0\n1 0 0\n0 0 1\n" +
         lists;
}

TEST(Read, Ply_strips_become_triangles) {
  const Mesh whole = read_as(strips_ply("6 0 1 2 3 0 1\n"), ".ply").mesh;
  EXPECT_EQ(whole.faces.size(), 4U);
  EXPECT_TRUE(check(whole).bakeable());
  for (const char* lists : {"3 0 1 2\n3 2 1 3\n3 2 3 0\n3 0 3 1\n",  // a list each
                            "9 0 1 2 3 -1 2 3 0 1\n",                // two strips in one list
                            "10 0 1 2 3 3 2 2 3 0 1\n"}) {  // led on by triangles without area
    SCOPED_TRACE(lists);
    EXPECT_EQ(surface(read_as(strips_ply(lists), ".ply").mesh), surface(whole));
  }
}

TEST(Read, Polygons_become_triangles) {
  const ReadMesh read = read_as("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", ".obj");
  EXPECT_EQ(read.file_faces, 1U);
  EXPECT_EQ(read.mesh.faces.size(), 2U);
}

TEST(Read, Equal_positions_are_welded) {
  const ReadMesh read = read_as(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 1 0 0\nv 0 -1 0\n"
      "f 1 2 3\nf 5 4 6\n",
      ".obj");
  EXPECT_EQ(read.file_vertices, 6U);
  EXPECT_EQ(read.mesh.points.size(), 4U);
  EXPECT_EQ(check(read.mesh).components, 1U);
}

TEST(Read, Unreferenced_vertices_are_dropped) {
  const ReadMesh read = read_as("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n", ".obj");
  EXPECT_EQ(read.mesh.points, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(Read, Unit_scale_multiplies) {
  EXPECT_EQ(surface(read_as(to_obj(cube()), ".obj", 0.001).mesh), surface(cube({0, 0, 0}, 0.001)));
}

TEST(Read, Sha256_is_of_the_bytes) {
  const ReadMesh a = read_as(to_obj(cube()), ".obj");
  const ReadMesh b = read_as(to_obj(cube()) + "\n", ".obj");
  EXPECT_NE(a.sha256, b.sha256);
  // Of the 52 bytes below, from another implementation.
  const ReadMesh known = read_as("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ".obj");
  EXPECT_EQ(known.sha256[0], 0x69);
}

TEST(Read, Written_ply_comes_back_as_it_was) {
  const Mesh mesh = sphere({0.1, 0.2, 0.3}, 1.0 / 3);
  const std::vector<std::byte> ply = to_ply(mesh);
  std::string bytes(ply.size(), '\0');
  std::memcpy(bytes.data(), ply.data(), ply.size());
  EXPECT_EQ(surface(read_as(bytes, ".ply").mesh), surface(mesh));
}

TEST(Read, Written_ply_keeps_equal_positions_apart) {
  const Mesh mesh = together(cube(), cube({1, 1, 0}));  // touching along an edge
  const std::vector<std::byte> ply = to_ply(mesh);
  std::string bytes(ply.size(), '\0');
  std::memcpy(bytes.data(), ply.data(), ply.size());
  const Mesh read = read_as(bytes, ".ply").mesh;
  EXPECT_EQ(read.points.size(), 16U);
  EXPECT_TRUE(check(read).bakeable());
}

TEST(Read, Bad_files_are_refused_with_place_and_fix) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string ply = to_ply_ascii(cube());
  const struct {
    std::string bytes, extension, says;
  } cases[] = {
      {"", ".obj", "empty"},
      {"", ".stl", "empty"},
      {"hello\n", ".xyz", "format not recognised"},
      {"\xFE\xFF"
       "abc",
       ".obj", "UTF-16"},
      {obj, ".obj", "no triangles"},
      {obj + "f 1 2 4\n", ".obj", "out of range"},
      {obj + "f 1 2 -4\n", ".obj", ":4: "},
      {obj + "f 0 1 2\n", ".obj", "out of range"},
      {obj + "f 1 2\n", ".obj", "fewer than three"},
      {obj + "f 1 2 3x\n", ".obj", "'3x' is not a whole number"},
      {obj + "f 1 2 99999999999999999999\n", ".obj", "not a whole number"},
      {"v 0 0\nf 1 1 1\n", ".obj", "coordinate missing"},
      {"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ".obj", "finite"},
      {"v 0 0 1e999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ".obj", "not a number"},
      {"OFF\n353535235358 2 0\n", ".off", "does not fit"},
      {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ".off", "out of range"},
      {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", ".off", "vertex index missing"},
      {"4OFF\n3 1 0\n", ".off", "three coordinates"},
      {replaced(ply, "vertex 8", "vertex 99999999999"), ".ply", "does not fit"},
      {replaced(ply, "int vertex_indices", "float vertex_indices"), ".ply", "vertex_indices"},
      {replaced(ply, "float z", "float w"), ".ply", "x, y and z"},
      {replaced(ply, "float z", "quad z"), ".ply", "number type"},
      {replaced(ply, "ascii", "text"), ".ply", "PLY format"},
      {replaced(ply, "end_header", "end"), ".ply", "end_header"},
      {strips_ply("6 0 1 2 3 0 4\n"), ".ply", "out of range"},
      {strips_ply("6 0 1 2 3 0 -2\n"), ".ply", "negative"},
      {replaced(strips_ply("6 0 1 2 3 0 1\n"), "list int int", "list int float"), ".ply",
       "vertex_indices"},
      {"plain text\n", ".ply", "not a PLY"},
      {to_stl_binary(cube()) + "x", ".stl", "counts 12 triangles but 601 bytes"},
      {to_stl_binary(cube()) + "seven b", ".stl", "7 bytes after the last triangle"},
      {to_stl_binary(cube()).substr(0, 300), ".stl", "the file is cut"},
      {to_stl_ascii(cube()).substr(0, 300), ".stl", "missing"},
      {replaced(to_stl_ascii(cube()), "endsolid", "the end"), ".stl",
       "'endsolid' missing before 'the'"},
      {replaced(to_stl_ascii(cube()), "endsolid of a test\n", ""), ".stl",
       "'endsolid' missing, the file is cut"},
      {replaced(to_stl_ascii(cube()), "endloop", "vertex 0 0 0\nendloop"), ".stl",
       "'endloop' missing"},
      {replaced(to_stl_ascii(cube()), "vertex 1", "vertex one"), ".stl", "'one' is not a number"},
      {"solid a\nendsolid a\n", ".stl", "no triangles"},
  };
  for (const auto& c : cases) {
    const std::string message = refusal(c.bytes, c.extension);
    EXPECT_NE(message.find(c.says), std::string::npos) << c.says << " | " << message;
    EXPECT_NE(message.find(c.extension), std::string::npos) << "no place in: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(Read, Missing_file_or_folder_is_refused) {
  EXPECT_THROW((void)read_mesh("/no/such/mesh.obj"), InputRefused);
  EXPECT_THROW((void)read_mesh(std::filesystem::temp_directory_path()), InputRefused);
}

TEST(Read, Overflow_of_the_unit_scale_is_refused) {
  EXPECT_THROW((void)read_as(to_obj(cube({0, 0, 0}, 1e200)), ".obj", 1e200), InputRefused);
}

}  // namespace
}  // namespace palpate::bake::testing

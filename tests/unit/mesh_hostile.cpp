// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever the bytes, read_mesh() refuses them or gives a mesh that everything after it can take.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host_bake/base/error.hpp"
#include "host_bake/mesh/check.hpp"
#include "mesh_support.hpp"

namespace palpate::bake::testing {
namespace {

struct Sample {
  std::string name, bytes, extension;
};

/// Lines end in carriage returns alone, the solid in "end solid".
std::string to_stl_ascii_of_two_words(const Mesh& mesh) {
  std::string text = to_stl_ascii(mesh);
  text.insert(text.rfind("endsolid") + 3, " ");
  std::ranges::replace(text, '\n', '\r');
  return text;
}

/// Corners of its own for each face, some a unit of float away from others.
Mesh rounded_apart(const Mesh& mesh) {
  Mesh soup;
  for (const Face& face : mesh.faces) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (const std::uint32_t v : face) {
      soup.points.push_back(mesh.points[v]);
      for (double& x : soup.points.back()) {
        if (soup.faces.size() % 2 == 0) x += 0x1p-24;
      }
    }
    soup.faces.push_back({first, first + 1, first + 2});
  }
  return soup;
}

std::vector<Sample> samples() {
  const Mesh mesh = cube();
  return {{"obj", to_obj(mesh), ".obj"},
          {"off", to_off(mesh), ".off"},
          {"off_binary", to_off_binary(mesh), ".off"},
          {"stl_ascii", to_stl_ascii(mesh), ".stl"},
          {"stl_carriage_returns", to_stl_ascii_of_two_words(mesh), ".stl"},
          {"stl_binary", to_stl_binary(mesh), ".stl"},
          {"ply_ascii", to_ply_ascii(mesh), ".ply"},
          {"ply_little", to_ply_binary(mesh, std::endian::little), ".ply"},
          {"ply_carriage_returns", to_ply_binary(mesh, std::endian::little, "\r"), ".ply"},
          {"ply_big", to_ply_binary(mesh, std::endian::big), ".ply"},
          {"stl_soup", to_stl_binary(rounded_apart(mesh)), ".stl"}};
}

/// False where the bytes are refused.
bool digest(const std::string& bytes, const std::string& extension) {
  try {
    Mesh mesh = read_as(bytes, extension).mesh;
    EXPECT_FALSE(mesh.faces.empty());
    for (const Point& p : mesh.points) {
      for (const double x : p) EXPECT_TRUE(std::isfinite(x));
    }
    for (const Face& f : mesh.faces) {
      for (const std::uint32_t v : f) EXPECT_LT(v, mesh.points.size());
    }
    (void)check(mesh);
    repair(mesh);
    (void)check(mesh);
    return true;
  } catch (const InputRefused&) {
    return false;
  }
}

class Hostile : public ::testing::TestWithParam<Sample> {};

TEST_P(Hostile, Truncated_at_every_length_is_refused_or_sound) {
  const Sample& sample = GetParam();
  for (std::size_t length = 0; length < sample.bytes.size(); ++length) {
    const bool read = digest(sample.bytes.substr(0, length), sample.extension);
    // OBJ does not say how much is to come. The others notice every loss but that of the end of the
    // last line.
    if (sample.name == "obj" || length + 12 > sample.bytes.size()) continue;
    EXPECT_FALSE(read) << "cut to " << length << " of " << sample.bytes.size();
  }
}

TEST_P(Hostile, Flipped_bytes_are_refused_or_sound) {
  const Sample& sample = GetParam();
  std::mt19937 random(23);
  for (int round = 0; round < 1500; ++round) {
    std::string bytes = sample.bytes;
    for (int i = 0; i <= round % 4; ++i) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    digest(bytes, sample.extension);
  }
}

TEST_P(Hostile, Swapped_digits_are_refused_or_sound) {
  const Sample& sample = GetParam();
  std::mt19937 random(29);
  for (int round = 0; round < 500; ++round) {
    std::string bytes = sample.bytes;
    for (char& c : bytes) {
      const bool digit = c >= '0' && c <= '9';
      if (digit && random() % 40 == 0) c = static_cast<char>('0' + random() % 10);
    }
    digest(bytes, sample.extension);
  }
}

TEST_P(Hostile, Wrong_extension_changes_nothing_or_is_refused) {
  const Sample& sample = GetParam();
  for (const char* extension : {".obj", ".off", ".stl", ".ply", ".txt", ""}) {
    digest(sample.bytes, extension);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Hostile, ::testing::ValuesIn(samples()),
                         [](const auto& sample) { return sample.param.name; });

TEST(HostileBytes, Random_bytes_are_refused) {
  std::mt19937 random(31);
  for (const char* extension : {".obj", ".off", ".stl", ".ply", ".bin"}) {
    for (std::size_t length = 1; length < 200; ++length) {
      std::string bytes(length, '\0');
      for (char& c : bytes) c = static_cast<char>(random());
      EXPECT_FALSE(digest(bytes, extension));
    }
  }
}

TEST(HostileBytes, Counts_beyond_the_file_cost_nothing) {
  std::string ply = to_ply_binary(cube(), std::endian::little);
  ply.replace(ply.find("uchar int"), 9, "uint int ");
  EXPECT_FALSE(digest(ply, ".ply"));
  EXPECT_FALSE(digest("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", ".off"));
  EXPECT_FALSE(digest("ply\nformat ascii 1.0\nelement face 40\nend_header\n", ".ply"));
  EXPECT_FALSE(
      digest("ply\nformat ascii 1.0\nelement x 99999999999999999999\nend_header\n", ".ply"));
  std::string off = "OFF BINARY\n";
  for (const std::uint32_t count : {0xFFFFFFFFU, 0xFFFFFFFFU, 0U})
    append(off, count, std::endian::big);
  EXPECT_FALSE(digest(off, ".off"));
  std::string stl(80, ' ');
  append(stl, 0xFFFFFFFFU);
  EXPECT_FALSE(digest(stl, ".stl"));
}

}  // namespace
}  // namespace palpate::bake::testing

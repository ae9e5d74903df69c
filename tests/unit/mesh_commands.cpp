// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate check` and what `palpate bake` makes of bad meshes, as processes: verdict, exit status,
// one error line, no file left.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "host_bake/mesh/read.hpp"
#include "tests/support/process.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

class MeshCommands : public testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) {
    return folder_.write(name, text);
  }

  fs::path write(const std::string& name, const Mesh& mesh) {
    const auto bytes = bake::to_ply(mesh);
    return write(name, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }

  Outcome palpate(std::vector<std::string> arguments) const {
    arguments.emplace(arguments.begin(), PALPATE_EXECUTABLE);
    return run(std::move(arguments));
  }

  void expect_refused(const Outcome& o, int status, const std::string& said) const {
    EXPECT_EQ(o.status, status);
    EXPECT_EQ(o.err.rfind("palpate: error: ", 0), 0u) << o.err;
    EXPECT_NE(o.err.find(said), std::string::npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      EXPECT_NE(entry.path().filename().string().rfind("out", 0), 0u) << entry.path() << " is left";
    }
  }

  [[nodiscard]] std::string out(const std::string& name) const {
    return folder_.path() / ("out" + name);
  }

  TemporaryFolder folder_;
};

TEST_F(MeshCommands, check_of_a_sound_mesh_exits_with_0) {
  const Outcome o = palpate({"check", write("ball.ply", ball(6, 8, 1))});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_FALSE(o.out.empty());
}

TEST_F(MeshCommands, check_of_a_missing_file_exits_with_3) {
  expect_refused(palpate({"check", folder_.path() / "none.obj"}), 3, "none.obj");
}

TEST_F(MeshCommands, check_without_a_mesh_exits_with_2) {
  expect_refused(palpate({"check"}), 2, "mesh");
}

TEST_F(MeshCommands, check_of_a_broken_mesh_names_the_rule_and_exits_with_3) {
  Mesh m = ball(6, 8, 1);
  std::swap(m.faces[5][0], m.faces[5][1]);
  const std::string file = write("turned.ply", m);
  EXPECT_EQ(palpate({"check", file}).status, 3);
  expect_refused(palpate({"bake", file, "-o", out(".palp")}), 3, "orientation");
}

TEST_F(MeshCommands, repair_writes_a_mesh_that_bakes) {
  Mesh m = ball(6, 8, 1);
  std::swap(m.faces[5][0], m.faces[5][1]);
  m.faces.push_back(m.faces[3]);
  const std::string file = write("broken.ply", m);
  const Outcome o = palpate({"check", file, "--repair", out(".ply")});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(palpate({"check", out(".ply")}).status, 0);
  EXPECT_EQ(palpate({"bake", out(".ply"), "-o", out(".palp"), "--quiet"}).status, 0);
  EXPECT_EQ(palpate({"inspect", out(".palp"), "--verify"}).status, 0);
}

TEST_F(MeshCommands, names_of_formats_that_are_not_written_are_refused) {
  const std::string file = write("ball.ply", ball(6, 8, 1));
  const std::size_t before = folder_.files();
  for (const char* name : {"out.stl", "out.OBJ", "out.png"}) {
    const std::string out = folder_.path() / name;
    expect_refused(palpate({"check", file, "--repair", out}), 2, "another format");
    expect_refused(palpate({"make-model", "ellipsoid", "-o", out}), 2, "out.ply'");
  }
  EXPECT_EQ(folder_.files(), before);
  EXPECT_EQ(palpate({"check", file, "--repair", folder_.path() / "OUT.PLY"}).status, 0);
  EXPECT_EQ(palpate({"check", file, "--repair", folder_.path() / "out"}).status, 0);
}

TEST_F(MeshCommands, bake_with_repair_does_it_in_one_step) {
  Mesh m = ball(6, 8, 1);
  m.faces.push_back(m.faces[3]);
  const std::string file = write("double.ply", m);
  expect_refused(palpate({"bake", file, "-o", out(".palp")}), 3, "duplicate");
  EXPECT_EQ(palpate({"bake", file, "-o", out(".palp"), "--repair", "--quiet"}).status, 0);
}

/// An octahedron as ascii STL, each corner of each face off by up to `off` of its radius of 1.
std::string octahedron_soup(double off) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> error(-off, off);
  std::string text = "solid soup\n";
  for (unsigned octant = 0; octant < 8; ++octant) {
    text += "facet normal 0 0 0\nouter loop\n";
    const bool turned = std::popcount(octant) % 2 != 0;
    for (unsigned corner = 0; corner < 3; ++corner) {
      const unsigned axis = turned ? 2 - corner : corner;
      text += "vertex";
      for (unsigned i = 0; i < 3; ++i) {
        const double x = i != axis ? 0 : (octant >> i & 1U) != 0 ? -1 : 1;
        char word[40];
        std::snprintf(word, sizeof word, " %.17g", x + error(random));
        text += word;
      }
      text += "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "end solid soup\n";
}

TEST_F(MeshCommands, corners_that_differ_by_rounding_are_welded_and_named) {
  const std::string file = write("rounded.stl", octahedron_soup(3e-8));
  const Outcome checked = palpate({"check", file});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_NE(checked.out.find("components: 1 (1 closed)"), std::string::npos) << checked.out;
  EXPECT_NE(checked.out.find("welded: 18 corners that differed by rounding, largest gap "),
            std::string::npos)
      << checked.out;
  EXPECT_NE(palpate({"check", file, "--json"}).out.find("\"largest_gap_m\""), std::string::npos);
  EXPECT_EQ(palpate({"check", file, "--repair", out(".ply"), "--quiet"}).status, 0);
  const Outcome again = palpate({"check", out(".ply")});
  EXPECT_NE(again.out.find("8 triangles, 6 vertices"), std::string::npos) << again.out;
  const Outcome baked = palpate({"bake", file, "-o", out(".palp")});
  EXPECT_EQ(baked.status, 0) << baked.err;
  EXPECT_NE(baked.out.find("welded: 18 corners"), std::string::npos) << baked.out;
}

TEST_F(MeshCommands, soup_with_wider_cracks_is_refused_with_and_without_repair) {
  for (const double off : {1e-6, 1e-4}) {
    const std::string file = write("soup.stl", octahedron_soup(off));
    const std::string said = "corners nearly coincide (largest gap ";
    expect_refused(palpate({"check", file}), 3, said);
    expect_refused(palpate({"check", file, "--repair", out(".ply")}), 3, said);
    expect_refused(palpate({"bake", file, "-o", out(".palp"), "--quiet"}), 3, said);
    const Outcome o = palpate({"bake", file, "-o", out(".palp"), "--repair", "--quiet"});
    expect_refused(o, 3, said);
    EXPECT_NE(o.err.find(": weld them"), std::string::npos) << o.err;
  }
}

TEST_F(MeshCommands, strict_refuses_faces_that_cross) {
  Mesh m = ball(6, 8, 1);
  append(m, ball(6, 8, 1), 0.7, 0.2, 0.1);
  const std::string file = write("crossing.ply", m);
  expect_refused(palpate({"bake", file, "-o", out(".palp"), "--strict"}), 3, "cross");
  EXPECT_EQ(palpate({"bake", file, "-o", out(".palp"), "--quiet"}).status, 0);
}

TEST_F(MeshCommands, unreadable_meshes_exit_with_3_and_leave_nothing) {
  const std::pair<const char*, std::string> files[] = {
      {"empty.obj", ""},
      {"words.off", "these are words"},
      {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"},
      {"nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
      {"huge.off", "OFF\n999999999999 1 0\n0 0 0\n"},
      {"cut.stl", std::string("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nver")},
  };
  for (const auto& [name, text] : files) {
    const std::string file = write(name, text);
    expect_refused(palpate({"check", file}), 3, name);
    expect_refused(palpate({"bake", file, "-o", out(".palp")}), 3, name);
  }
}

TEST_F(MeshCommands, bake_refuses_options_out_of_range_with_2) {
  const std::string file = write("ball.ply", ball(6, 8, 1));
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"--delta", "0"},
                                             {"--delta", "nan"},
                                             {"--unit-scale", "-1"},
                                             {"--engine", "none"},
                                             {"--frobnicate"}}) {
    std::vector<std::string> call{"bake", file, "-o", out(".palp")};
    call.insert(call.end(), wrong.begin(), wrong.end());
    expect_refused(palpate(call), 2, wrong[0]);
  }
}

}  // namespace
}  // namespace palpate::test

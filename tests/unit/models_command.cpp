// SPDX-License-Identifier: GPL-3.0-or-later
// palpate make-model.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host_bake/mesh/read.hpp"
#include "host_bake/models/models.hpp"
#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

class MakeModel : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(file()); }
  void TearDown() override { std::filesystem::remove(file()); }

  static std::filesystem::path file() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::path(testing::TempDir()) / (std::string(test->name()) + ".ply");
  }

  static void run(const std::string& arguments) {
    CLI::App app;
    add_make_model(app);
    app.parse("make-model " + arguments + " -o " + file().string(), false);
  }

  /// Positions of all faces' corners, face by face.
  static std::vector<bake::Point> corners(const bake::Mesh& mesh) {
    std::vector<bake::Point> points;
    for (const bake::Face& f : mesh.faces) {
      for (const std::uint32_t v : f) points.push_back(mesh.points[v]);
    }
    return points;
  }

  static void expect_usage_failure(const std::string& arguments, const std::string& said) {
    try {
      run(arguments);
      FAIL() << "not refused: " << arguments;
    } catch (const Failure& e) {
      EXPECT_EQ(e.code, kUsage);
      EXPECT_NE(std::string(e.what()).find(said), std::string::npos) << e.what();
    }
    EXPECT_FALSE(std::filesystem::exists(file()));
  }
};

TEST_F(MakeModel, writes_the_mesh_that_is_read_back) {
  run("jaw_lower --triangles 2000 --seed 3");
  const bake::Mesh written = bake::make_model("jaw_lower", 2000, 3);
  const bake::ReadMesh read = bake::read_mesh(file());
  // The reader numbers vertices by first use.
  EXPECT_EQ(corners(read.mesh), corners(written));
}

TEST_F(MakeModel, defaults_to_the_paper_s_count) {
  run("ellipsoid");
  EXPECT_EQ(bake::read_mesh(file()).file_faces, 2000U);
}

TEST_F(MakeModel, unknown_name_is_a_usage_error) { expect_usage_failure("teapot", "teapot"); }

TEST_F(MakeModel, impossible_count_is_a_usage_error_naming_the_least) {
  expect_usage_failure("golf_club --triangles 10", "1000");
  expect_usage_failure("golf_club --triangles 900000000", "20000000");
}

TEST_F(MakeModel, negative_numbers_are_usage_errors) {
  EXPECT_THROW(run("nut --triangles -2000"), CLI::ParseError);
  EXPECT_THROW(run("nut --seed -1"), CLI::ParseError);
}

TEST_F(MakeModel, help_lists_every_model_with_its_count) {
  CLI::App app;
  add_make_model(app);
  const std::string help = app.get_subcommand("make-model")->help();
  for (const bake::ModelInfo& model : bake::models()) {
    EXPECT_NE(help.find(model.name), std::string::npos);
    EXPECT_NE(help.find(std::to_string(model.default_triangles)), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate::cli

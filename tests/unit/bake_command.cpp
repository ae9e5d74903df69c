// SPDX-License-Identifier: GPL-3.0-or-later
// palpate bake as a user sees it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/process.hpp"

namespace palpate {
namespace {

// A square pyramid in millimetres.
constexpr const char* kPyramid =
    "OFF\n5 6 0\n0 0 0\n20 0 0\n20 20 0\n0 20 0\n10 10 15\n"
    "3 0 2 1\n3 0 3 2\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";

// The same with one face twice.
constexpr const char* kDoubled =
    "OFF\n5 7 0\n0 0 0\n20 0 0\n20 20 0\n0 20 0\n10 10 15\n"
    "3 0 2 1\n3 0 3 2\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n3 3 0 4\n";

test::Outcome bake(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {PALPATE_EXECUTABLE, "bake"});
  return test::run(arguments);
}

void expect_refused(const test::Outcome& outcome, int status, const std::string& what) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  const std::size_t line = outcome.err.find("palpate: error: ");
  ASSERT_NE(line, std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(what, line), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\n', line), outcome.err.size() - 1) << outcome.err;
}

TEST(BakeCommand, Image_and_report_agree) {
  const test::TemporaryFolder folder;
  const std::string mesh = folder.write("p.off", kPyramid), image = folder.path() / "p.palp",
                    report = folder.path() / "r.json";
  const test::Outcome outcome = bake({mesh, "-o", image, "--unit-scale", "0.001", "--delta", "0.02",
                                      "--threads", "2", "--report", report});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(test::read_file(report));
  EXPECT_EQ(json["bytes"], std::filesystem::file_size(image));
  EXPECT_EQ(json["format_version"], "3.0");
  EXPECT_NEAR(json["radius_m"], 0.0145, 0.0005);
  EXPECT_EQ(json["source"]["triangles"], 6);
  EXPECT_EQ(json["source"]["sha256"].get<std::string>().size(), 64u);
  EXPECT_NEAR(json["delta_rel"], 0.02, 1e-6);
  EXPECT_EQ(json["levels"].size(), 1u);
  EXPECT_EQ(json["levels"][0]["triangles"], 6);
  EXPECT_GT(json["engine_bytes"], 0);
  EXPECT_GT(json["regions"]["count"], 0);
  EXPECT_GT(json["regions"]["nodes"], 0);
  EXPECT_GT(json["regions"]["largest_radius_rel"], 0);
  EXPECT_GT(json["regions"]["engine_bytes"], 0);
  EXPECT_EQ(json["threads"], 2);
  EXPECT_GT(json["peak_bytes"], 0);
  EXPECT_TRUE(json["seconds"].contains("decompose"));
  EXPECT_TRUE(json["rejected"].is_object());
}

TEST(BakeCommand, Mesh_of_many_metres_is_asked_about) {
  const test::TemporaryFolder folder;
  const std::string mesh = folder.write("p.off", kPyramid), image = folder.path() / "p.palp";
  const std::string question = "20 m across: millimetres? --unit-scale 0.001\n";
  EXPECT_NE(bake({mesh, "-o", image}).err.find("p.off: " + question), std::string::npos);
  EXPECT_EQ(bake({mesh, "-o", image, "--unit-scale", "1"}).err.find("millimetres"),
            std::string::npos);
  const std::string small = folder.write("s.off",
                                         "OFF\n4 4 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n3 0 2 1\n"
                                         "3 0 1 3\n3 1 2 3\n3 2 0 3\n");
  EXPECT_EQ(bake({small, "-o", image}).err.find("millimetres"), std::string::npos);
}

TEST(BakeCommand, Same_mesh_same_bytes) {
  const test::TemporaryFolder folder;
  const std::string mesh = folder.write("p.off", kPyramid), a = folder.path() / "a",
                    b = folder.path() / "b";
  ASSERT_EQ(bake({mesh, "-o", a, "--threads", "1", "--quiet"}).status, 0);
  const test::Outcome quiet = bake({mesh, "-o", b, "--threads", "2", "--quiet"});
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
  EXPECT_EQ(test::read_file(a), test::read_file(b));
}

TEST(BakeCommand, Repair_is_asked_for_and_told) {
  const test::TemporaryFolder folder;
  const std::string mesh = folder.write("d.off", kDoubled), image = folder.path() / "d.palp";
  expect_refused(bake({mesh, "-o", image}), 3, "duplicate face");
  EXPECT_FALSE(std::filesystem::exists(image));
  const test::Outcome fixed = bake({mesh, "-o", image, "--repair"});
  EXPECT_EQ(fixed.status, 0) << fixed.err;
  EXPECT_NE(fixed.out.find("repair: "), std::string::npos) << fixed.out;
}

TEST(BakeCommand, Detail_is_left_out_where_asked_and_told) {
  const test::TemporaryFolder folder;
  const std::string mesh = folder.path() / "ball.ply", image = folder.path() / "ball.palp",
                    report = folder.path() / "r.json";
  ASSERT_EQ(
      test::run({PALPATE_EXECUTABLE, "make-model", "golf_ball", "--triangles", "3000", "-o", mesh})
          .status,
      0);
  const test::Outcome outcome =
      bake({mesh, "-o", image, "--max-deviation", "0.01", "--report", report});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("detail: "), std::string::npos) << outcome.out;
  const auto json = nlohmann::json::parse(test::read_file(report));
  EXPECT_LT(json["source"]["triangles"], json["mesh_triangles"]);
  EXPECT_GT(json["source"]["deviation_rel"], 0.0);
  EXPECT_LE(json["source"]["deviation_rel"], 0.0101);
  EXPECT_TRUE(json["seconds"].contains("reduce"));
}

TEST(BakeCommand, What_is_wrong_is_refused_with_its_status) {
  const test::TemporaryFolder folder;
  const std::string mesh = folder.write("p.off", kPyramid), image = folder.path() / "p.palp";
  expect_refused(bake({mesh}), 2, "--output");
  expect_refused(bake({mesh, "-o", image, "--delta", "0"}), 2, "--delta");
  expect_refused(bake({mesh, "-o", image, "--delta", "nan"}), 2, "--delta");
  expect_refused(bake({mesh, "-o", image, "--threads", "-1"}), 2, "--threads");
  expect_refused(bake({mesh, "-o", image, "--engine", "neither"}), 2, "--engine");
  expect_refused(bake({mesh, "-o", image, "--s0-min", "0"}), 2, "--s0-min");
  expect_refused(bake({mesh, "-o", image, "--stop-resolution", "-1"}), 2, "--stop-resolution");
  expect_refused(bake({mesh, "-o", image, "--max-deviation", "0.2"}), 2, "--max-deviation");
  expect_refused(bake({mesh, "-o", image, "--max-deviation", "nan"}), 2, "--max-deviation");
  expect_refused(bake({mesh, "-o", image, "--support-area", "none"}), 2, "--support-area");
  expect_refused(bake({mesh, "-o", image, "--max-bytes", "100"}), 3,
                 "the smallest that serves has");
  expect_refused(bake({folder.path() / "none.off", "-o", image}), 3, "none.off");
  expect_refused(bake({folder.write("bad.off", "OFF\n1 1 0\n"), "-o", image}), 3, "bad.off");
  EXPECT_FALSE(std::filesystem::exists(image));
}

TEST(BakeCommand, Outputs_appear_both_or_not_at_all) {
  const test::TemporaryFolder folder;
  const std::string mesh = folder.write("p.off", kPyramid), image = folder.path() / "p.palp";
  expect_refused(bake({mesh, "-o", image, "--report", folder.path() / "no" / "r.json"}), 1,
                 "r.json");
  EXPECT_FALSE(std::filesystem::exists(image));
}

}  // namespace
}  // namespace palpate

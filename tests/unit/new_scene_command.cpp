// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate new-scene` and `palpate try` as a user meets them: two small meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// A box of half sides about a middle, as an OFF file.
std::string box(double x, double y, double z, double middle = 0) {
  std::ostringstream off;
  off << "OFF\n8 12 0\n";
  for (int corner = 0; corner < 8; ++corner) {
    off << middle + (corner & 1 ? x : -x) << " " << middle + (corner & 2 ? y : -y) << " "
        << middle + (corner & 4 ? z : -z) << "\n";
  }
  off << "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n"
         "3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n3 3 7 5\n";
  return off.str();
}

class NewScene : public ::testing::Test {
 protected:
  NewScene() {
    folder_.write("plate.off", box(30, 40, 5));     // millimetres
    folder_.write("stamp.off", box(8, 9, 6, 100));  // off its origin
    folder_.write("metres.off", box(.008, .009, .006));
  }

  test::Outcome palpate(std::vector<std::string> words) const {
    words.insert(words.begin(), PALPATE_EXECUTABLE);
    return test::run_in(folder_.path(), words);
  }

  [[nodiscard]] std::string file(const std::string& name) const {
    return test::read_file(folder_.path() / name);
  }

  /// The distance of the bodies where the scene puts them.
  [[nodiscard]] double gap_m() const {
    folder_.write("start.csv",
                  "t,body,px,py,pz,qw,qx,qy,qz\n0,stamp," + position("stamp") + ",1,0,0,0\n");
    const test::Outcome outcome = palpate(
        {"replay", "scene.toml", "--poses", "start.csv", "-o", "ticks.csv", "--exact", "--quiet"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::istringstream rows(file("ticks.csv"));
    std::string field;
    std::getline(rows, field);
    for (int i = 0; i < 11; ++i) std::getline(rows, field, ',');
    return field.empty() ? std::nan("") : std::stod(field);
  }

  /// "x,y,z" of a body of the scene.
  [[nodiscard]] std::string position(const std::string& body) const {
    const std::string scene = file("scene.toml");
    const std::size_t from = scene.find("position = [", scene.find("\"" + body + "\"")) + 12;
    std::string text = scene.substr(from, scene.find(']', from) - from);
    text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
    return text;
  }

  test::TemporaryFolder folder_;
};

TEST_F(NewScene, Millimetres_are_guessed_and_said) {
  const test::Outcome outcome =
      palpate({"new-scene", "stamp.off", "plate.off", "-o", "scene.toml"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("plate.off: 60 x 80 x 10, in millimetres by its size; --unit-scale S "
                             "says otherwise"),
            std::string::npos)
      << outcome.out;
  const auto image = nlohmann::json::parse(palpate({"inspect", "plate.palp", "--json"}).out);
  EXPECT_NEAR(image["radius_m"], 0.05025, 0.0001);
}

TEST_F(NewScene, Metres_beside_millimetres_are_told_apart) {
  const test::Outcome outcome =
      palpate({"new-scene", "metres.off", "plate.off", "-o", "scene.toml"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("metres.off: 0.016 x 0.018 x 0.012, in metres"), std::string::npos);
  EXPECT_NE(outcome.out.find("plate.off: 60 x 80 x 10, in millimetres"), std::string::npos);
}

TEST_F(NewScene, Unit_scale_takes_the_place_of_the_guess) {
  const test::Outcome outcome = palpate(
      {"new-scene", "stamp.off", "plate.off", "-o", "scene.toml", "--unit-scale", "0.0254"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("by its size"), std::string::npos) << outcome.out;
  const auto image = nlohmann::json::parse(palpate({"inspect", "plate.palp", "--json"}).out);
  EXPECT_NEAR(image["radius_m"], 0.05025 * 25.4, 0.001);
}

TEST_F(NewScene, Tool_stands_one_delta_off_along_the_least_extent) {
  ASSERT_EQ(palpate({"new-scene", "stamp.off", "plate.off", "-o", "scene.toml"}).status, 0);
  const std::string scene = file("scene.toml");
  EXPECT_NE(scene.find("engine = \"regions\""), std::string::npos);
  const std::size_t at = scene.find("delta_m = ") + 10;
  const double delta_m = std::stod(scene.substr(at));
  EXPECT_NEAR(delta_m, 0.000135, 0.00001);  // a hundredth of the stamp's radius
  // The plate's middle is the world's; the stamp's is above it by half of both heights.
  EXPECT_EQ(position("plate"), "0,0,0");
  double x = 0, y = 0, z = 0;
  ASSERT_EQ(std::sscanf(position("stamp").c_str(), "%lf,%lf,%lf", &x, &y, &z), 3);
  EXPECT_NEAR(x, -0.1, 1e-9);
  EXPECT_NEAR(y, -0.1, 1e-9);
  EXPECT_NEAR(z, -0.1 + 0.011 + delta_m, 0.02 * delta_m);
  // The contact tolerance is where distances end: just inside of it or just out.
  const double gap = gap_m();
  if (!std::isnan(gap)) {
    EXPECT_NEAR(gap, delta_m, 0.02 * delta_m);
  }
}

TEST_F(NewScene, Other_commands_take_what_it_writes) {
  ASSERT_EQ(palpate({"new-scene", "stamp.off", "plate.off", "-o", "scene.toml"}).status, 0);
  EXPECT_TRUE(std::isnan(gap_m()) || gap_m() > 0);
  const test::Outcome run = palpate({"run", "scene.toml", "--seconds", "0.2", "--quiet"});
  EXPECT_TRUE(run.status == 0 || run.status == 5) << run.err;
  const test::Outcome sweep =
      palpate({"sweep", "scene.toml", "--poses", "start.csv", "-o", "sweep", "--quiet"});
  EXPECT_EQ(sweep.status, 0) << sweep.err;
}

TEST_F(NewScene, One_mesh_against_itself_is_baked_once) {
  const test::Outcome outcome =
      palpate({"new-scene", "stamp.off", "stamp.off", "-o", "scene.toml"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "stamp_2.palp"));
  EXPECT_NE(file("scene.toml").find("name = \"stamp_2\"\nimage = \"stamp.palp\""),
            std::string::npos);
}

TEST_F(NewScene, Repairs_what_is_safe_and_says_so) {
  std::string doubled = box(8, 9, 6);
  doubled.replace(doubled.find("8 12 0"), 6, "8 13 0");
  folder_.write("doubled.off", doubled + "3 0 2 1\n");
  const test::Outcome outcome =
      palpate({"new-scene", "doubled.off", "plate.off", "-o", "scene.toml"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("doubled.off: 1 duplicate face"), std::string::npos) << outcome.out;
}

TEST_F(NewScene, Names_that_a_pose_file_could_not_hold_are_changed) {
  folder_.write("a, \"b\".off", box(8, 9, 6));
  const test::Outcome outcome =
      palpate({"new-scene", "a, \"b\".off", "plate.off", "-o", "scene.toml"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(file("scene.toml").find("name = \"a___b_\""), std::string::npos);
  EXPECT_EQ(palpate({"run", "scene.toml", "--seconds", "0.1", "--quiet"}).err, "");
}

TEST_F(NewScene, Refused_mesh_leaves_nothing_behind) {
  folder_.write("words.off", "these are words");
  const std::size_t before = folder_.files();
  const test::Outcome outcome =
      palpate({"new-scene", "stamp.off", "words.off", "-o", "scene.toml"});
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  EXPECT_NE(outcome.err.find("palpate: error: "), std::string::npos);
  EXPECT_EQ(folder_.files(), before);
  EXPECT_EQ(palpate({"new-scene", "stamp.off", "plate.off", "-o", "no/scene.toml"}).status, 1);
  EXPECT_EQ(folder_.files(), before);
}

TEST_F(NewScene, Try_leaves_a_folder_with_all_of_it) {
  const test::Outcome outcome =
      palpate({"try", "stamp.off", "plate.off", "-o", "tried", "--seconds", "1", "--no-browser"});
  ASSERT_TRUE(outcome.status == 0 || outcome.status == 5) << outcome.err;
  for (const char* name : {"scene.toml", "stamp.palp", "plate.palp", "motion.csv", "run.trace"}) {
    EXPECT_TRUE(fs::exists(folder_.path() / "tried" / name)) << name;
  }
  EXPECT_NE(outcome.out.find("$ palpate run tried/scene.toml --poses tried/motion.csv"),
            std::string::npos)
      << outcome.out;
  if (outcome.err.find("no report") != std::string::npos) GTEST_SKIP() << "no page: no node";
  EXPECT_NE(outcome.err.find("Live view: http://127.0.0.1:"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("\nReport: "), std::string::npos) << outcome.out;
  EXPECT_GT(fs::file_size(folder_.path() / "tried/report.html"), 10000u);
}

TEST_F(NewScene, Motion_of_try_touches) {
  palpate({"try", "stamp.off", "plate.off", "-o", "tried", "--seconds", "1", "--no-browser"});
  const test::Outcome outcome = palpate(
      {"replay", "tried/scene.toml", "--poses", "tried/motion.csv", "-o", "ticks.csv", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["ticks"], 101);
  EXPECT_GT(json["force_N"]["max"], 0.05);
  EXPECT_EQ(outcome.err.find("overlap"), std::string::npos);
}

}  // namespace
}  // namespace palpate

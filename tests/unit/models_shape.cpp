// SPDX-License-Identifier: GPL-3.0-or-later
// Each procedural model for itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "host_bake/base/error.hpp"
#include "host_bake/models/models.hpp"
#include "tests/support/effort.hpp"
#include "tests/unit/models_geometry.hpp"

namespace palpate {
namespace {

using bake::make_model;
using bake::Mesh;
using bake::ModelInfo;
using bake::Point;

class Model : public testing::TestWithParam<ModelInfo> {};

void expect_sound(const Mesh& mesh, const ModelInfo& model, std::size_t wanted) {
  SCOPED_TRACE(std::string(model.name) + " of " + std::to_string(wanted));
  const test::Topology t = test::topology(mesh);
  EXPECT_TRUE(t.closed_manifold);
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.euler, model.name == "nut" ? 0 : 2);
  EXPECT_GT(t.volume_m3, 0.0);
  EXPECT_NEAR(static_cast<double>(mesh.faces.size()), static_cast<double>(wanted),
              0.02 * static_cast<double>(wanted));
}

TEST_P(Model, any_count_gives_closed_outward_manifold) {
  const ModelInfo& model = GetParam();
  constexpr std::size_t kStep = test::effort<std::size_t>(17, 39);
  for (std::size_t wanted = model.least_triangles; wanted < 12000; wanted = wanted * kStep / 13) {
    expect_sound(make_model(model.name, wanted), model, wanted);
  }
}

TEST_P(Model, any_count_is_free_of_self_crossings) {
  const ModelInfo& model = GetParam();
  for (const std::size_t wanted : {model.least_triangles, std::size_t{1501}, std::size_t{7000}}) {
    EXPECT_EQ(test::self_crossings(make_model(model.name, wanted)), 0U) << wanted;
  }
}

TEST_P(Model, other_seeds_are_sound) {
  const ModelInfo& model = GetParam();
  for (const std::uint64_t seed : {0ULL, 7ULL, ~0ULL}) {
    const Mesh mesh = make_model(model.name, 3000, seed);
    expect_sound(mesh, model, 3000);
    EXPECT_EQ(test::self_crossings(mesh), 0U);
  }
}

TEST_P(Model, default_count_gives_closed_outward_manifold) {
  const ModelInfo& model = GetParam();
  expect_sound(make_model(model.name), model, model.default_triangles);
}

TEST_P(Model, radius_is_as_listed) {
  const double radius_m = test::radius_m(make_model(GetParam().name, 8000));
  EXPECT_NEAR(radius_m, GetParam().radius_m, 0.03 * GetParam().radius_m);
}

TEST_P(Model, impossible_count_is_refused_naming_the_least) {
  const ModelInfo& model = GetParam();
  EXPECT_THROW(make_model(model.name, bake::kMostModelTriangles + 1), bake::InputRefused);
  try {
    make_model(model.name, model.least_triangles - 1);
    FAIL() << "not refused";
  } catch (const bake::InputRefused& e) {
    const std::string message = e.what();
    EXPECT_NE(message.find(std::to_string(model.least_triangles)), std::string::npos) << message;
  }
}

TEST_P(Model, coordinates_are_on_the_grid) {
  for (const Point& p : make_model(GetParam().name, 2000).points) {
    for (const double c : p) EXPECT_EQ(c * 0x1p35, std::floor(c * 0x1p35));
  }
}

std::string name_of(const testing::TestParamInfo<ModelInfo>& info) {
  return std::string(info.param.name);
}

INSTANTIATE_TEST_SUITE_P(all, Model,
                         testing::ValuesIn(bake::models().begin(), bake::models().end()), name_of);

TEST(Models, unknown_name_is_refused) { EXPECT_THROW(make_model("teapot"), bake::InputRefused); }

// The same on every compiler and machine: these change only when a model is meant to change.
TEST(Models, golden_fingerprints) {
  const std::map<std::string, std::uint64_t> golden{
      {"golf_ball", 0x974C7C780F52C02EU},      {"golf_shell", 0x2FA85B87EAC90755U},
      {"golf_club", 0xB6CDB52B96C1C788U},      {"ball_joint_head", 0xC363F89C48C80388U},
      {"ball_joint_cup", 0x30C1546164144E70U}, {"jaw_lower", 0x4DBE32E9D167EEB5U},
      {"jaw_upper", 0xC067170A7BFFABC8U},      {"ellipsoid", 0x654B514AABD216E5U},
      {"screw", 0x8163E2D4C3A7E73AU},          {"nut", 0x62815EE018C98866U},
  };
  for (const ModelInfo& model : bake::models()) {
    const std::string name(model.name);
    EXPECT_EQ(test::fingerprint(make_model(name, 6000, 42)), golden.at(name)) << name;
  }
}

TEST(Models, seed_changes_all_but_the_ellipsoid) {
  for (const ModelInfo& model : bake::models()) {
    const std::uint64_t one = test::fingerprint(make_model(model.name, 4000, 1));
    const std::uint64_t two = test::fingerprint(make_model(model.name, 4000, 2));
    EXPECT_EQ(one == two, model.name == "ellipsoid") << model.name;
  }
}

TEST(Ellipsoid, every_edge_is_convex) {
  for (const std::size_t wanted : {100U, 322U, 778U, 2000U, 5000U, 20000U}) {
    EXPECT_EQ(test::edges_not_convex(make_model("ellipsoid", wanted)), 0U) << wanted;
  }
}

double length(const Point& p) { return std::hypot(p[0], p[1], p[2]); }

/// Vertices well below the sphere and nearer to the origin than all their neighbours.
std::vector<Point> lowest_points(const Mesh& mesh) {
  std::vector<char> lowest(mesh.points.size(), 1);
  for (const bake::Face& f : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = f[k];
      const std::uint32_t b = f[(k + 1) % 3];
      lowest[length(mesh.points[a]) < length(mesh.points[b]) ? b : a] = 0;
    }
  }
  std::vector<Point> found;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const bool deep = length(mesh.points[v]) < 0.02135 - 0.0001;
    if (lowest[v] != 0 && deep) found.push_back(mesh.points[v]);
  }
  return found;
}

TEST(GolfBall, has_336_dimples_apart_from_each_other) {
  for (const std::uint64_t seed : {1ULL, 9ULL}) {
    const std::vector<Point> dimples = lowest_points(make_model("golf_ball", 0, seed));
    ASSERT_EQ(dimples.size(), 336U);
    double least = 1.0;
    for (std::size_t i = 0; i < dimples.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        least =
            std::min(least, std::hypot(dimples[i][0] - dimples[j][0], dimples[i][1] - dimples[j][1],
                                       dimples[i][2] - dimples[j][2]));
      }
    }
    EXPECT_GT(least, 0.0037) << "dimples overlap";
  }
}

TEST(GolfBall, dimples_are_a_quarter_millimetre_deep) {
  double low = 1.0;
  double high = 0.0;
  for (const Point& p : make_model("golf_ball").points) {
    low = std::min(low, length(p));
    high = std::max(high, length(p));
  }
  EXPECT_NEAR(high, 0.02135, 1e-8);
  EXPECT_NEAR(high - low, 0.00025, 1e-5);
}

}  // namespace
}  // namespace palpate

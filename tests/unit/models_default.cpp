// SPDX-License-Identifier: GPL-3.0-or-later
// The models at their default counts and beyond: what takes longer than a regular test may.
#include <gtest/gtest.h>

#include <string>

#include "host_bake/models/models.hpp"
#include "tests/unit/models_geometry.hpp"

namespace palpate {
namespace {

using bake::make_model;

TEST(DefaultModels, are_free_of_self_crossings) {
  for (const bake::ModelInfo& model : bake::models()) {
    EXPECT_EQ(test::self_crossings(make_model(model.name)), 0U) << model.name;
  }
}

TEST(DefaultModels, pairs_keep_the_clearance) {
  const char* const pairs[][2] = {{"golf_ball", "golf_shell"},
                                  {"ball_joint_head", "ball_joint_cup"},
                                  {"jaw_lower", "jaw_upper"},
                                  {"screw", "nut"}};
  for (const auto& pair : pairs) {
    const bake::Mesh inner = make_model(pair[0]);
    const bake::Mesh outer = make_model(pair[1]);
    const test::Clearance c = test::clearance(inner, outer);
    EXPECT_EQ(c.crossings, 0U) << pair[0];
    for (const bake::Mesh& mesh : {inner, outer}) {
      EXPECT_GE(c.least_m, 0.002 * test::radius_m(mesh)) << pair[0];
      EXPECT_LE(c.least_m, 0.010 * test::radius_m(mesh)) << pair[0];
    }
  }
}

TEST(LargeModels, two_million_triangles_are_closed) {
  for (const bake::ModelInfo& model : bake::models()) {
    const bake::Mesh mesh = make_model(model.name, 2'000'000);
    EXPECT_EQ(mesh.faces.size(), 2'000'000U) << model.name;
    EXPECT_TRUE(test::topology(mesh).closed_manifold) << model.name;
  }
}

}  // namespace
}  // namespace palpate

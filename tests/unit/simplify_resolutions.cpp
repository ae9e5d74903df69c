// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's five models down to the coarsest resolutions of its Table 2. How many triangles are
// left there follows from the surface's area, as long as hardly any edge is left that is shorter
// than the resolution; printed beside the counts: the edge of an equilateral triangle of mean area,
// in units of 1 / r (1.34 for the paper's golf ball).
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include "host_bake/decompose/geometry.hpp"
#include "host_bake/models/models.hpp"
#include "simplify_judge.hpp"

namespace palpate::bake {
namespace {

struct Row {
  const char* model;
  double resolution;
  double shorter;  // part of the edges that may be shorter than 1 / r; measured, and half as much
};

class Simplify_paper_models : public testing::TestWithParam<Row> {};

TEST_P(Simplify_paper_models, hardly_keep_edges_below_their_resolution) {
  const Row& row = GetParam();
  const test::Simplified result = test::simplified(make_model(row.model, 0), {row.resolution, 0});
  ASSERT_FALSE(result.levels.empty());
  const SimplifiedLevel& last = result.levels.back();
  double area = 0;
  std::size_t shorter = 0;
  for (const Face& f : last.mesh.faces) {
    area += 0.5 * norm(area_vector(last.mesh, f));
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d edge = position(last.mesh, f[i]) - position(last.mesh, f[(i + 1) % 3]);
      if (norm(edge) * row.resolution < 1) ++shorter;
    }
  }
  const auto faces = static_cast<double>(last.mesh.faces.size());
  const double edge = std::sqrt(area / faces / std::sqrt(3.0) * 4) * row.resolution;
  std::cout << row.model << ": r " << row.resolution << ", triangles " << last.mesh.faces.size()
            << ", pieces " << last.patches.size() << ", area " << area << ", edge x r " << edge
            << '\n';
  EXPECT_LT(static_cast<double>(shorter), row.shorter * 3 * faces);
  EXPECT_GT(edge, 1.34);
  std::uint64_t refused = 0;
  for (const auto& [reason, count] : result.report.refused) refused += count;
  EXPECT_EQ(result.report.collapses + refused, result.report.attempts);
}

INSTANTIATE_TEST_SUITE_P(Table_2, Simplify_paper_models,
                         testing::Values(Row{"jaw_lower", 12.23, 0.03},
                                         Row{"jaw_upper", 19.21, 0.05},
                                         Row{"ball_joint_head", 6.75, 0.02},
                                         Row{"golf_club", 8.31, 0.1}, Row{"golf_ball", 7.16, 0.02}),
                         [](const auto& at) { return std::string(at.param.model); });

}  // namespace
}  // namespace palpate::bake

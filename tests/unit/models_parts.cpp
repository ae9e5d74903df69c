// SPDX-License-Identifier: GPL-3.0-or-later
// What the models are made of: angles, noise, blends, spines, rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "host_bake/models/blend.hpp"
#include "host_bake/models/loft.hpp"
#include "host_bake/models/noise.hpp"
#include "host_bake/models/round.hpp"
#include "host_bake/models/spine.hpp"
#include "host_bake/models/trig.hpp"
#include "tests/unit/models_geometry.hpp"

namespace palpate::bake {
namespace {

constexpr double kTwoPi = 6.283185307179586476925;

TEST(Turns, sine_and_cosine_agree_with_the_library) {
  for (int i = -20000; i <= 20000; ++i) {
    const double t = i / 7777.0;
    EXPECT_NEAR(sin_turns(t), std::sin(kTwoPi * t), 5e-15);
    EXPECT_NEAR(cos_turns(t), std::cos(kTwoPi * t), 5e-15);
  }
}

TEST(Turns, quarters_are_exact) {
  EXPECT_EQ(sin_turns(0.0), 0.0);
  EXPECT_EQ(sin_turns(0.5), 0.0);
  EXPECT_NEAR(sin_turns(0.25), 1.0, 2.3e-16);
  EXPECT_NEAR(cos_turns(3.0), 1.0, 2.3e-16);
}

// First outputs for seed 1234567, of the reference implementation (Vigna, splitmix64.c).
TEST(Random, follows_the_published_sequence) {
  Random random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317U);
  EXPECT_EQ(random.next(), 3203168211198807973U);
  EXPECT_EQ(random.next(), 9817491932198370423U);
}

TEST(Random, signed_units_stay_in_range_and_have_no_drift) {
  Random random(5);
  double sum = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double x = random.signed_unit();
    ASSERT_GE(x, -1.0);
    ASSERT_LT(x, 1.0);
    sum += x;
  }
  EXPECT_NEAR(sum / 10000.0, 0.0, 0.03);
}

TEST(Noise, is_continuous_bounded_and_zero_on_the_lattice) {
  EXPECT_EQ(noise({3.0, -2.0, 7.0}, 11), 0.0);
  Random random(3);
  double greatest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Point p{20.0 * random.signed_unit(), 20.0 * random.signed_unit(),
                  20.0 * random.signed_unit()};
    const double here = noise(p, 11);
    greatest = std::max(greatest, std::abs(here));
    EXPECT_NEAR(noise({p[0] + 1e-7, p[1], p[2]}, 11), here, 1e-6);
  }
  EXPECT_GT(greatest, 0.3);
  EXPECT_LE(greatest, 1.0);
}

TEST(Blend, smooth_extremes_never_pass_the_sharp_ones) {
  for (int i = -50; i <= 50; ++i) {
    const double a = i / 10.0;
    EXPECT_LE(smooth_min(a, 0.5, 1.0), std::min(a, 0.5));
    EXPECT_GE(smooth_max(a, 0.5, 1.0), std::max(a, 0.5));
    if (std::abs(a - 0.5) > 1.0) {
      EXPECT_EQ(smooth_min(a, 0.5, 1.0), std::min(a, 0.5));
    }
  }
}

TEST(Spine, constant_curvature_gives_a_circle) {
  const Spine spine([](double s) { return s / kTwoPi; }, kTwoPi);
  for (int i = 0; i <= 100; ++i) {
    const double s = kTwoPi * i / 100.0;
    const SpinePoint p = spine.at(s);
    EXPECT_NEAR(p.x, std::sin(s), 1e-8);
    EXPECT_NEAR(p.y, 1.0 - std::cos(s), 1e-8);
    EXPECT_NEAR(p.tx, std::cos(s), 1e-12);
  }
}

std::size_t vertices(const std::vector<Row>& rows) {
  std::size_t sum = 0;
  for (const Row& row : rows) sum += row.count;
  return sum;
}

TEST(Rows, hold_exactly_the_vertices_asked_for) {
  for (std::size_t wanted = 20; wanted < 3000; wanted = wanted * 5 / 4 + 1) {
    EXPECT_EQ(vertices(plan_body(unit_sphere(), 0.0, 1.0, wanted)), wanted);
    EXPECT_EQ(vertices(plan_rows(unit_sphere(), 0.2, 0.7, wanted, Last::ring)), wanted);
  }
}

TEST(Rows, ascend_to_the_end_and_end_in_a_pole) {
  const std::vector<Row> rows = plan_body(unit_sphere(), 0.0, 1.0, 500);
  EXPECT_EQ(rows.front().count, 1U);
  EXPECT_EQ(rows.back().count, 1U);
  EXPECT_EQ(rows.back().v, 1.0);
  for (std::size_t k = 1; k < rows.size(); ++k) EXPECT_LT(rows[k - 1].v, rows[k].v);
}

TEST(Loft, sphere_is_its_delaunay_triangulation) {
  for (const std::size_t wanted : {30U, 101U, 517U, 2000U}) {
    const std::vector<Row> rows = plan_body(unit_sphere(), 0.0, 1.0, wanted);
    const Mesh mesh = loft(unit_sphere(), rows, Ends::poles);
    EXPECT_EQ(mesh.faces.size(), 2 * wanted - 4);
    EXPECT_EQ(test::edges_not_convex(mesh), 0U) << wanted;
    EXPECT_GT(test::topology(mesh).volume_m3, 0.0);
  }
}

TEST(Loft, mirrored_surface_still_looks_outward) {
  const Surface mirrored = [](double v) -> Curve {
    return [v](double u) { return direction(-u, v); };
  };
  const Mesh mesh = loft(mirrored, plan_body(mirrored, 0.0, 1.0, 200), Ends::poles);
  EXPECT_GT(test::topology(mesh).volume_m3, 0.0);
}

}  // namespace
}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of solids that touch and overlap, where mechanics says what they are.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

constexpr double kStiffness = 600;
constexpr double kDelta = 5e-4;
constexpr double kStep = 5e-6;

const Settings kSettings{.engine = EngineKind::regions,
                         .delta_m = kDelta,
                         .exact = true,
                         .stiffness_N_per_m = kStiffness,
                         .cluster_radius_m = 3e-3};

BakedBody baked(bake::Mesh mesh) { return BakedBody(std::move(mesh), bake::ForEngine::regions); }

/// By its edges.
bake::Mesh block(double x, double y, double z) { return box(x / 2, y / 2, z / 2); }

bake::Mesh moved(const bake::Mesh& mesh, double x, double y, double z) {
  bake::Mesh out;
  append(out, mesh, x, y, z);
  return out;
}

/// Profile in x and z, counter-clockwise, extruded along y from -h to h; convex but for `notch`.
bake::Mesh prism(const std::vector<std::pair<double, double>>& profile,
                 const std::vector<std::array<std::uint32_t, 3>>& cap, double h) {
  bake::Mesh m;
  const auto n = static_cast<std::uint32_t>(profile.size());
  for (const double y : {-h, h}) {
    for (const auto& [x, z] : profile) m.points.push_back({x, y, z});
  }
  for (const auto& [a, b, c] : cap) {
    m.faces.push_back({a, b, c});
    m.faces.push_back({a + n, c + n, b + n});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    m.faces.push_back({i, i + n, j + n});
    m.faces.push_back({i, j + n, j});
  }
  return m;
}

bake::Mesh groove() {
  return prism({{-.03, -.03}, {.03, -.03}, {.03, 0}, {.02, 0}, {0, -.02}, {-.02, 0}, {-.03, 0}},
               {{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 4, 5}, {0, 5, 6}}, .02);
}

bake::Mesh wedge(double half_width) {
  return prism({{0, 0}, {half_width, .008}, {-half_width, .008}}, {{0, 1, 2}}, .012);
}

struct Way {
  Pose start;
  Vec3d step_m;
  int ticks = 0;
  [[nodiscard]] Pose at(int i) const {
    return {start.position_m + double(i) * step_m, start.orientation};
  }
};

using Want = std::function<Vec3d(const Pose&)>;

/// Exact forces along a way are those of mechanics, the same on the way back, and change no faster
/// than three stiffnesses.
void expect_forces(const BakedBody& tool, const BakedBody& base, const Way& way, const Want& want,
                   double tolerance_N = 1e-4) {
  BakedScene scene({tool.view, base.view}, {{0, 1}}, kSettings);
  std::vector<Vec3d> forward;
  for (int i = 0; i < way.ticks; ++i) {
    const Pose poses[2] = {way.at(i), {}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    EXPECT_FALSE(r.certificate.truncated()) << i;
    ASSERT_LT(norm(r.wrench.force_N - want(poses[0])), tolerance_N)
        << i << ": " << r.wrench.force_N.x << " " << r.wrench.force_N.y << " "
        << r.wrench.force_N.z;
    forward.push_back(r.wrench.force_N);
    if (i == 0) continue;
    const double changed = norm(forward[std::size_t(i)] - forward[std::size_t(i) - 1]);
    EXPECT_LE(changed, 3 * kStiffness * norm(way.step_m) + 1e-3) << i;
  }
  for (int i = way.ticks; i-- > 0;) {
    const Pose poses[2] = {way.at(i), {}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    EXPECT_LT(norm(r.wrench.force_N - forward[std::size_t(i)]), 1e-6) << i;
  }
}

Want upwards(double lowest) {
  return [lowest](const Pose& p) {
    const double gap = p.position_m.z - lowest;
    return Vec3d{0, 0, kStiffness * std::max(0.0, kDelta - gap)};
  };
}

TEST(ContactMechanics, a_box_pressed_flat_is_pushed_back_whatever_the_tessellation) {
  for (const int times : {0, 1, 2}) {
    const BakedBody tool = baked(quartered(block(.018, .018, .018), times));
    const BakedBody base = baked(moved(quartered(block(.1, .1, .02), times + 1), 0, 0, -.01));
    const Way way{{{.001, .0007, .009 + kDelta}, turn({0, 0, .7})}, {0, 0, -2 * kStep}, 150};
    expect_forces(tool, base, way, upwards(.009));
  }
}

TEST(ContactMechanics, a_box_sliding_flat_meets_no_edge_inside_the_plate) {
  const BakedBody tool = baked(quartered(block(.018, .018, .018), 2));
  const BakedBody base = baked(moved(quartered(block(.1, .1, .02), 3), 0, 0, -.01));
  for (const double depth : {1e-5, 3e-4}) {
    const Way way{{{-.003, .002, .009 - depth}, turn({0, 0, .3})}, {2 * kStep, kStep, 0}, 100};
    expect_forces(tool, base, way, upwards(.009));
  }
}

TEST(ContactMechanics, a_box_past_a_tables_edge_is_not_kicked_sideways) {
  const BakedBody tool = baked(block(.02, .02, .02));
  const BakedBody base = baked(block(.04, .04, .01));
  for (const double depth : {1e-4, 2e-4, 5e-4}) {
    expect_forces(tool, base, {{{.0105, .0011, .015 - depth}, {}}, {6e-5, 0, 0}, 140},
                  upwards(.015));
    expect_forces(tool, base, {{{.01 - 3e-4, .0013, .015 - depth}, {}}, {4e-6, 0, 0}, 150},
                  upwards(.015));
  }
}

TEST(ContactMechanics, what_sinks_wholly_is_as_deep_as_its_lowest_point) {
  bake::Mesh tetrahedron;
  const double s = .002;
  tetrahedron.points = {{s, s, s}, {-s, -s, s}, {-s, s, -s}, {s, -s, -s}};
  tetrahedron.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const BakedBody base = baked(moved(quartered(block(.08, .08, .04), 1), 0, 0, -.02));
  for (const bake::Mesh& mesh : {tetrahedron, quartered(block(2 * s, 2 * s, 2 * s), 1)}) {
    const Way way{{{.0011, .0007, s + kDelta}, {}}, {0, 0, -4 * kStep}, 280};
    expect_forces(baked(mesh), base, way, upwards(s));
  }
}

TEST(ContactMechanics, a_ball_over_a_wide_face_is_felt_at_once_with_a_small_budget) {
  constexpr double kRadius = .0018;
  const BakedBody tool = baked(ball(12, 24, kRadius));
  const BakedBody base = baked(moved(quartered(block(.08, .08, .04), 2), 0, 0, -.02));
  Settings settings = kSettings;
  settings.exact = false;
  // Over the middle of the face and beside edges of its triangles.
  for (const Vec3d at : {Vec3d{.0011, .0007, 0}, Vec3d{.0101, .0007, 0}, Vec3d{-.0007, .0098, 0}}) {
    BakedScene scene({tool.view, base.view}, {{0, 1}}, settings);
    for (int i = 0; i < 20; ++i) {
      const double gap = kDelta - 4 * i * kStep;
      const Pose poses[2] = {{{at.x, at.y, kRadius + gap}, {}}, {}};
      const TickResult r = tick_or_fail(*scene.engine, poses, {.units = 500});
      EXPECT_NEAR(r.wrench.force_N.z, kStiffness * (kDelta - gap), .01 * kStiffness * kDelta)
          << i << " over " << at.x << " " << at.y;
    }
  }
}

TEST(ContactMechanics, a_thin_plate_pushes_back_to_its_middle_and_never_pulls) {
  for (const double thick : {1.0, 2.0, 4.0}) {
    const double half = thick * kDelta / 2;
    const BakedBody tool = baked(quartered(block(.016, .016, .016), 1));
    const BakedBody plate = baked(quartered(block(.04, .04, 2 * half), 2));
    BakedScene scene({tool.view, plate.view}, {{0, 1}}, kSettings);
    for (double bottom = half + kDelta; bottom > -half; bottom -= 2 * kStep) {
      const Pose poses[2] = {{{.0007, .0003, .008 + bottom}, {}}, {}};
      const TickResult r = tick_or_fail(*scene.engine, poses);
      EXPECT_GT(r.wrench.force_N.z, -.05 * kStiffness * kDelta) << bottom;
      if (bottom < .1 * half) continue;
      EXPECT_NEAR(r.wrench.force_N.z, kStiffness * std::max(0.0, kDelta - bottom + half), 2e-3);
    }
  }
}

/// Each wall of the groove pushes by its own gap or depth.
Vec3d both_walls(const Pose& p) {
  const double root2 = std::numbers::sqrt2;
  const auto strength = [&](double side) {
    return std::max(0.0, kDelta - (p.position_m.z + .02 + side * p.position_m.x) / root2);
  };
  const double right = strength(1), left = strength(-1);
  return {kStiffness * (right - left) / root2, 0, kStiffness * (right + left) / root2};
}

TEST(ContactMechanics, a_wedge_in_a_groove_feels_both_walls) {
  const BakedBody tool = baked(wedge(.008)), base = baked(groove());
  expect_forces(tool, base, {{{-1.6e-4, .0007, -.02 + 2e-4}, {}}, {2e-6, 0, 0}, 160}, both_walls,
                2e-3);
  const Way pressed{{{0, .0007, -.02 + kDelta * std::numbers::sqrt2}, {}}, {0, 0, -kStep}, 200};
  expect_forces(tool, base, pressed, both_walls, 2e-2);
}

// A vertex has a contact beside each of the cavity's edges: more than eight in the mean.
TEST(ContactMechanics, a_ball_in_a_cavity_that_fits_it_has_room_for_all_its_contacts) {
  bake::Mesh cavity = ball(24, 48, .0101);
  for (bake::Face& f : cavity.faces) std::swap(f[1], f[2]);
  append(cavity, block(.04, .04, .04), 0, 0, 0);
  const BakedBody tool = baked(ball(24, 48, .01)), base = baked(std::move(cavity));
  Settings settings = kSettings;
  settings.delta_m = 1.5e-3;
  BakedScene scene({tool.view, base.view}, {{0, 1}}, settings, {.contacts = 1u << 20});
  const Pose poses[2] = {{{0, 0, -.002}, {}}, {}};
  const TickResult r = tick_or_fail(*scene.engine, poses);
  EXPECT_FALSE(r.certificate.truncated_by_memory);
  EXPECT_GT(r.wrench.force_N.z, kStiffness * kDelta);
}

TEST(ContactMechanics, what_a_does_to_b_b_does_to_a) {
  const BakedBody a = baked(quartered(block(.016, .012, .018), 1)), b = baked(ball(12, 16, .008));
  BakedScene one({a.view, b.view}, {{0, 1}}, kSettings);
  BakedScene other({b.view, a.view}, {{0, 1}}, kSettings);
  for (int i = 0; i < 40; ++i) {
    const Vec3d way{std::sin(1.7 * i), std::cos(2.3 * i), std::sin(0.9 * i + 1)};
    const Pose pose{(.006 + 2e-4 * i) / norm(way) * way, turn(0.08 * i * way)};
    const Pose first[2] = {pose, {}};
    const Pose second[2] = {{}, pose};
    const Vec3d f = tick_or_fail(*one.engine, first).wrench.force_N;
    const Vec3d g = tick_or_fail(*other.engine, second).wrench.force_N;
    EXPECT_LT(norm(f + g), 1e-6 + 1e-3 * norm(f)) << i;
  }
}

TEST(ContactMechanics, forces_do_not_depend_on_the_scale) {
  for (const double scale : {1e-4, 1e4}) {
    const BakedBody tool = baked(scaled(block(.018, .018, .018), scale));
    const BakedBody base = baked(scaled(moved(block(.1, .1, .02), 0, 0, -.01), scale));
    Settings settings = kSettings;
    settings.delta_m *= scale;
    settings.cluster_radius_m *= scale;
    BakedScene scene({tool.view, base.view}, {{0, 1}}, settings);
    for (int i = 0; i < 60; ++i) {
      const double z = .009 + kDelta - 2e-5 * i;
      const Pose poses[2] = {{{0, 0, scale * z}, turn({0, 0, .4})}, {}};
      const Vec3d f = (1 / scale) * tick_or_fail(*scene.engine, poses).wrench.force_N;
      EXPECT_LT(norm(f - upwards(.009)({{0, 0, z}, {}})), 1e-4) << i;
    }
  }
}

}  // namespace
}  // namespace palpate::test

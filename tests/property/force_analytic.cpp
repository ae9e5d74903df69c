// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes whose wrench is known in closed form, through both engines, to 1e-4 of the force.
#include <gtest/gtest.h>

#include <numbers>

#include "rt_core/force/coupling.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

constexpr double kDelta_m = 0.0005, kStiffness_N_per_m = 600, kRelative = 1e-4;

BakedBody body(bake::Mesh mesh) { return BakedBody(std::move(mesh), bake::ForEngine::both); }

/// The first body is the tool, the others stay at the origin.
class AnalyticScene : public testing::TestWithParam<EngineKind> {
 protected:
  void load(std::initializer_list<const BakedBody*> bodies) {
    std::vector<ImageView> views;
    std::vector<BodyPair> pairs;
    for (const BakedBody* b : bodies) views.push_back(b->view);
    for (std::uint32_t i = 1; i < views.size(); ++i) pairs.push_back({0, i});
    Settings settings{.engine = GetParam(), .delta_m = kDelta_m, .exact = exact_};
    settings.stiffness_N_per_m = kStiffness_N_per_m;
    scene_ = std::make_unique<BakedScene>(views, pairs, settings);
  }
  TickResult at(const Pose& tool) {
    std::vector<Pose> poses(scene_->bodies.size());
    poses[0] = tool;
    return tick_or_fail(*scene_->engine, poses);
  }
  static double spring_N(double gap_m) { return kStiffness_N_per_m * (kDelta_m - gap_m); }
  static void expect_force(const TickResult& r, Vec3d expected_N) {
    EXPECT_NEAR(norm(r.wrench.force_N - expected_N), 0, kRelative * norm(expected_N));
  }
  /// The torque of that force at a point, from the tool's origin.
  static void expect_at(const TickResult& r, Vec3d arm_m) {
    const Vec3d torque_Nm = cross(arm_m, r.wrench.force_N);
    EXPECT_NEAR(norm(r.wrench.torque_Nm - torque_Nm), 0,
                kRelative * norm(r.wrench.force_N) * norm(arm_m) + 1e-9);
  }
  std::unique_ptr<BakedScene> scene_;
  bool exact_ = true;
};

Vec3d unit(const bake::Point& p) {
  const Vec3d v{p[0], p[1], p[2]};
  return (1 / norm(v)) * v;
}

/// The shortest turn that takes one direction to another; not opposed.
Quat turn_onto(Vec3d from, Vec3d to) {
  const Vec3d axis = cross(from, to);
  const double w = 1 + dot(from, to);
  const double length = std::sqrt(w * w + dot(axis, axis));
  return {w / length, axis.x / length, axis.y / length, axis.z / length};
}

TEST_P(AnalyticScene, sphere_on_sphere) {
  constexpr double kA_m = 0.02, kB_m = 0.015;
  // Corners of the meshes are on the spheres: where two face each other, the distance is theirs.
  // So few of them that no other corner comes within delta.
  const BakedBody a = body(ball(10, 14, kA_m)), b = body(ball(8, 12, kB_m));
  load({&a, &b});
  for (std::size_t i = 0; i < b.mesh.points.size(); i += 7) {
    const Vec3d direction = unit(b.mesh.points[i]);
    const Vec3d corner = unit(a.mesh.points[a.mesh.points.size() - 1 - i]);
    if (dot(corner, direction) > 0.99) continue;
    // The normal of two corners is known to the rounding of floats over their gap.
    for (const double gap_m : {0.4e-3, 0.25e-3, 0.1e-3}) {
      const TickResult r = at({(kA_m + kB_m + gap_m) * direction, turn_onto(corner, -direction)});
      expect_force(r, spring_N(gap_m) * direction);
      EXPECT_LT(norm(r.wrench.torque_Nm), kRelative * kA_m * norm(r.wrench.force_N));
    }
  }
}

TEST_P(AnalyticScene, torque_is_about_the_origin_of_the_tool) {
  constexpr double kRadius_m = 0.02;
  const Vec3d centre_m{0.03, -0.01, 0.02};  // of the ball, in the tool's axes
  bake::Mesh away;
  append(away, ball(10, 14, kRadius_m), centre_m.x, centre_m.y, centre_m.z);
  const BakedBody a = body(away), b = body(box(0.05, 0.05, 0.01));
  load({&a, &b});
  for (const double gap_m : {0.3e-3, 0.05e-3}) {
    // The ball's south pole over the plate's upper face.
    const Vec3d over_m{0.004, 0.003, 0.01 + gap_m + kRadius_m};
    const TickResult r = at({over_m - centre_m, {}});
    expect_force(r, {0, 0, spring_N(gap_m)});
    expect_at(r, centre_m - Vec3d{0, 0, kRadius_m + 0.5 * gap_m});
  }
}

TEST_P(AnalyticScene, box_face_on_a_plane) {
  constexpr double kHalf_m = 0.01;
  const BakedBody a = body(box(kHalf_m, kHalf_m, kHalf_m)), b = body(box(0.05, 0.05, 0.01));
  load({&a, &b});
  for (const double gap_m : {0.4e-3, 0.1e-3, 0.01e-3, -0.01e-3, -0.1e-3, -0.4e-3}) {
    const TickResult r = at({{0.002, 0.001, 0.01 + gap_m + kHalf_m}, {}});
    expect_force(r, {0, 0, spring_N(gap_m)});
    // Any point of the face is a closest one: the force acts in the middle, or with the witnesses
    // of a few regions somewhere on it.
    const double farthest_m =
        GetParam() == EngineKind::levels ? kRelative * kHalf_m : std::numbers::sqrt2 * kHalf_m;
    EXPECT_LE(norm(r.wrench.torque_Nm), farthest_m * norm(r.wrench.force_N));
  }
}

/// Regions share a face as they are cut.
/// Of the front alone: what an exact query feels are the surfaces.
class LevelsScene : public AnalyticScene {
 protected:
  LevelsScene() { exact_ = false; }
};
/// Hulls of thick solids reach behind the faces that are beside them.
class RegionsScene : public AnalyticScene {};

TEST_P(LevelsScene, box_that_rocks_on_a_plane_is_set_back) {
  constexpr double kHalf_m = 0.01, kGap_m = 0.1e-3;
  const BakedBody a = body(box(kHalf_m, kHalf_m, kHalf_m)), b = body(box(0.05, 0.05, 0.01));
  load({&a, &b});
  for (const double tilt : {-5e-3, -1e-3, -1e-5, 1e-5, 1e-3, 5e-3}) {
    const double half_width_m = kHalf_m * std::cos(tilt);
    const double middle_m = kHalf_m * std::sin(tilt);  // of the face, left of the box's
    const double low_m = kHalf_m * std::cos(tilt) + kHalf_m * std::sin(std::abs(tilt));
    const TickResult r = at({{0, 0, 0.01 + kGap_m + low_m}, turn({0, tilt, 0})});
    expect_force(r, {0, 0, spring_N(kGap_m)});
    // Of a foundation of that stiffness in all, spread evenly over the face.
    const double reach_m = kDelta_m - kGap_m - half_width_m * std::abs(std::tan(tilt));
    const double lever_m = half_width_m * half_width_m * std::tan(tilt) / (3 * reach_m);
    expect_at(r, {lever_m - middle_m, 0, -low_m});
  }
}

// A face that lies on a face is nearest at one edge or the other. Where the force acts is told by
// the torque.
TEST_P(LevelsScene, place_of_the_force_does_not_leap_as_a_body_rocks_on_a_plane) {
  constexpr double kGap_m = 0.1e-3;
  constexpr int kTicks = 2000;
  const BakedBody plate = body(box(0.05, 0.05, 0.01));
  for (const auto& [name, mesh] : {std::pair{"cube", box(0.01, 0.01, 0.01)},
                                   std::pair{"cylinder", cylinder(48, 0.008, 0.02)}}) {
    const BakedBody rocked = body(mesh);
    load({&rocked, &plate});
    double largest_m = 0;
    Vec3d before{};
    for (int i = 0; i <= kTicks; ++i) {
      const double s = static_cast<double>(i) / kTicks;
      const Quat leaning = turn({0.03 * (s - 0.5), 0.2 * (s - 0.5), 0.5 * s});
      double low_m = 0;
      for (const bake::Point& p : mesh.points)
        low_m = std::min(low_m, (rotation(leaning) * Vec3d{p[0], p[1], p[2]}).z);
      const TickResult r = at({{0, 0, 0.01 + kGap_m - low_m}, leaning});
      const Vec3d place =
          (1 / r.wrench.force_N.z) * Vec3d{-r.wrench.torque_Nm.y, r.wrench.torque_Nm.x, 0};
      if (i > 0) largest_m = std::max(largest_m, norm(place - before));
      before = place;
    }
    EXPECT_LT(largest_m, 0.5e-3) << name;
    RecordProperty(std::string(name) + "_mm", std::to_string(1e3 * largest_m));
  }
}

/// How large the triangles are says nothing about which way leads out.
TEST_P(AnalyticScene, leaning_box_of_many_triangles_is_pushed_out_of_a_plane_along_its_normal) {
  constexpr double kHalf_m = 0.01, kGap_m = -0.3e-3;
  constexpr int kTicks = 200;
  const bake::Mesh cube = quartered(box(kHalf_m, kHalf_m, kHalf_m), 3);
  const BakedBody a = body(cube), b = body(quartered(box(0.05, 0.05, 0.01), 5));
  load({&a, &b});
  for (int i = 0; i <= kTicks; ++i) {
    const double lean = 0.4 * i / kTicks - 0.2;
    const Quat leaning = turn({0.29 * lean, 0.96 * lean, 0});
    double low_m = 0;
    for (const bake::Point& p : cube.points)
      low_m = std::min(low_m, (rotation(leaning) * Vec3d{p[0], p[1], p[2]}).z);
    expect_force(at({{0.001, 0.002, 0.01 + kGap_m - low_m}, leaning}), {0, 0, spring_N(kGap_m)});
  }
}

using Polygon = std::vector<std::pair<double, double>>;  ///< x and z, counter-clockwise from y < 0

/// A bar along y of a section that is cut into triangles.
bake::Mesh bar(const Polygon& section, std::initializer_list<bake::Face> cut) {
  constexpr double kHalf_m = 0.03;
  bake::Mesh m;
  for (const double y : {-kHalf_m, kHalf_m}) {
    for (const auto& [x, z] : section) m.points.push_back({x, y, z});
  }
  const auto count = static_cast<std::uint32_t>(section.size());
  for (const bake::Face& f : cut) {
    m.faces.push_back(f);
    m.faces.push_back({f[0] + count, f[2] + count, f[1] + count});
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    m.faces.push_back({i, i + count, next + count});
    m.faces.push_back({i, next + count, next});
  }
  return m;
}

bake::Mesh groove() {
  return bar({{-0.03, -0.03},
              {0.03, -0.03},
              {0.03, 0.02},
              {0.02, 0.02},
              {0.0, 0.0},
              {-0.02, 0.02},
              {-0.03, 0.02}},
             {{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 4, 5}, {0, 5, 6}});
}

/// A floor at z = 0 that ends at x = 0 in a wall up or down.
bake::Mesh floor_and_wall_up() {
  return bar({{-0.02, -0.02}, {0.03, -0.02}, {0.03, 0}, {0, 0}, {0, 0.03}, {-0.02, 0.03}},
             {{0, 1, 3}, {1, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}
bake::Mesh floor_and_wall_down() {
  return bar({{-0.03, -0.03}, {0.03, -0.03}, {0.03, -0.015}, {0, -0.015}, {0, 0}, {-0.03, 0}},
             {{0, 1, 3}, {1, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}

/// Patches of a fine mesh are thin, and what has passed through them is on their inner side. Both
/// walls are felt all the same.
TEST_P(AnalyticScene, ball_pressed_into_a_groove_of_many_triangles_is_pushed_out_by_both_walls) {
  constexpr double kRadius_m = 0.009;
  const bake::Mesh sphere = ball(24, 32, kRadius_m);
  const BakedBody a = body(sphere), b = body(quartered(groove(), 3));
  load({&a, &b});
  const double s = std::numbers::sqrt2 / 2;
  for (int i = 0; i <= 60; ++i) {
    const double overlap_m = 0.3e-3 * i / 60;
    const Quat turned = turn({0.1 * i, 0.05 * i, 0.02});
    double low_m[2] = {};  // of the corners, from the ball's middle along either wall's normal
    for (const bake::Point& p : sphere.points) {
      const Vec3d q = rotation(turned) * Vec3d{p[0], p[1], p[2]};
      low_m[0] = std::min(low_m[0], s * (q.x + q.z));
      low_m[1] = std::min(low_m[1], s * (q.z - q.x));
    }
    const double from_m[2] = {-low_m[0] - overlap_m, -low_m[1] - 0.5 * overlap_m};
    const TickResult r =
        at({{s * (from_m[0] - from_m[1]), 0.001 * std::sin(0.3 * i), s * (from_m[0] + from_m[1])},
            turned});
    const double first_N = spring_N(-overlap_m), second_N = spring_N(-0.5 * overlap_m);
    const Vec3d expected_N{s * (first_N - second_N), 0, s * (first_N + second_N)};
    EXPECT_NEAR(norm(r.wrench.force_N - expected_N), 0, 0.05 * norm(expected_N)) << i;
  }
}

/// Where its edges lie exactly along those of the corner, the nearest points of what has passed
/// through are on the crease, which is the inner side of both walls.
TEST_P(AnalyticScene, box_of_many_triangles_in_line_with_a_corner_is_pushed_out_by_both_walls) {
  constexpr double kHalf_m = 0.01;
  const BakedBody a = body(quartered(box(kHalf_m, kHalf_m, kHalf_m), 3)),
                  b = body(quartered(floor_and_wall_up(), 3));
  load({&a, &b});
  for (const double overlap_m : {-0.1e-3, 0.02e-3, 0.2e-3}) {
    const Vec3d expected_N{spring_N(-overlap_m), 0, spring_N(-0.8 * overlap_m)};
    const TickResult r = at({{kHalf_m - overlap_m, 0, kHalf_m - 0.8 * overlap_m}, {}});
    EXPECT_NEAR(norm(r.wrench.force_N - expected_N), 0, 0.03 * norm(expected_N)) << overlap_m;
  }
}

/// However deep it is in the wall, it is in the floor only as deep as it is in the floor.
TEST_P(RegionsScene,
       box_of_many_triangles_deep_in_a_wall_is_lifted_by_the_floor_as_far_as_it_is_in) {
  constexpr double kHalf_m = 0.01, kInWall_m = 0.4e-3, kInFloor_m = 0.02e-3;
  const BakedBody a = body(quartered(box(kHalf_m, kHalf_m, kHalf_m), 3)),
                  b = body(quartered(floor_and_wall_up(), 3));
  load({&a, &b});
  for (int i = 0; i <= 60; ++i) {
    const TickResult r = at({{kHalf_m - kInWall_m, 0.003 * std::sin(0.1 * i), kHalf_m - kInFloor_m},
                             turn({0, 2e-4 * i - 6e-3, 0})});
    EXPECT_NEAR(r.wrench.force_N.z, spring_N(-kInFloor_m), 0.2 * spring_N(0)) << i;
  }
}

/// The regions of its sides that the edge has entered tell ways out as long as the box.
TEST_P(RegionsScene, box_of_many_triangles_on_the_edge_of_a_step_is_pushed_off_along_its_face) {
  constexpr double kHalf_m = 0.01, kOverlap_m = 0.25e-3;
  const BakedBody a = body(quartered(box(kHalf_m, kHalf_m, kHalf_m), 3)),
                  b = body(quartered(floor_and_wall_down(), 3));
  load({&a, &b});
  for (int i = 0; i <= 60; ++i) {
    const Quat leaning = turn({0, 0.3 + 0.1 * std::sin(0.1 * i), 0});
    const Mat3d r = rotation(leaning);
    const Vec3d up = r * Vec3d{0, 0, 1};
    const Vec3d on_face_m =
        r * Vec3d{0.004 * std::sin(0.1 * i), 0.003 * std::cos(0.2 * i), -kHalf_m};
    const TickResult result = at({-on_face_m - kOverlap_m * up, leaning});
    const Vec3d expected_N = spring_N(-kOverlap_m) * up;
    EXPECT_NEAR(norm(result.wrench.force_N - expected_N), 0, 0.1 * norm(expected_N)) << i;
  }
}

TEST_P(AnalyticScene, box_pressed_flat_through_a_virtual_tool_comes_to_rest) {
  constexpr double kHalf_m = 0.01, kPeriod_s = 1e-3;
  const BakedBody a = body(box(kHalf_m, kHalf_m, kHalf_m)), b = body(box(0.05, 0.05, 0.01));
  load({&a, &b});
  for (const Vec3d lean : {Vec3d{}, Vec3d{0, 2e-3, 0}, Vec3d{1e-3, -3e-3, 0.1}}) {
    force::VirtualTool tool({});
    tool.reset({{0, 0, 0.0205}, turn(lean)});
    double largest_Nm = 0;
    Vec3d before_Nm{};
    for (int i = 0; i < 3000; ++i) {
      const TickResult r = at(tool.pose());
      tool.step({{0, 0, 0.019}, turn(lean)}, r.wrench, r.stiffness, kPeriod_s);
      if (i > 1000) largest_Nm = std::max(largest_Nm, norm(r.wrench.torque_Nm - before_Nm));
      before_Nm = r.wrench.torque_Nm;
    }
    EXPECT_LT(largest_Nm, 1e-6);
  }
}

TEST_P(AnalyticScene, box_edge_on_edge) {
  constexpr double kHalf_m = 0.01;
  const BakedBody a = body(box(kHalf_m, kHalf_m, kHalf_m)),
                  b = body(box(kHalf_m, kHalf_m, kHalf_m));
  constexpr double kEighth = std::numbers::pi / 4;
  // Both are stood on edges that cross at a right angle: the tool along x, and the other, which
  // cannot be turned here, is the same as seen from its own axes.
  const Quat other = turn({0, kEighth, 0});
  const Quat back{other.w, -other.x, -other.y, -other.z};
  load({&a, &b});
  const Vec3d up = rotation(back) * Vec3d{0, 0, 1};
  const double reach_m = std::numbers::sqrt2 * kHalf_m;
  for (const double gap_m : {0.3e-3, 0.05e-3}) {
    const Vec3d shift_m = rotation(back) * Vec3d{0.002, -0.003, 0};
    const TickResult r = at({(2 * reach_m + gap_m) * up + shift_m, back * turn({kEighth, 0, 0})});
    expect_force(r, spring_N(gap_m) * up);
    // The edges cross where the tool's runs over the other's: straight below the tool in y, above
    // the other in x.
    const Vec3d cross_m = rotation(back) * Vec3d{-0.002, 0, -reach_m - 0.5 * gap_m};
    expect_at(r, cross_m);
  }
}

/// A region that ends beside the place where the edges cross is nearest there, and leans.
TEST_P(AnalyticScene, edges_of_boxes_of_many_triangles_cross_without_pushing_along_each_other) {
  constexpr double kHalf_m = 0.01, kGap_m = 0.2e-3;
  constexpr int kTicks = 200;
  constexpr double kEighth = std::numbers::pi / 4;
  const bake::Mesh cube = quartered(box(kHalf_m, kHalf_m, kHalf_m), 4);
  const BakedBody a = body(cube), b = body(cube);
  const Quat other = turn({0, kEighth, 0});
  const Quat back{other.w, -other.x, -other.y, -other.z};
  load({&a, &b});
  const Vec3d up = rotation(back) * Vec3d{0, 0, 1};
  const double force_N = spring_N(kGap_m);
  for (const double angle : {2 * kEighth, 1.5 * kEighth, kEighth}) {
    SCOPED_TRACE(angle);
    const double aside = angle - 2 * kEighth;
    const Quat across = turn({0, 0, aside});
    for (int i = 0; i < kTicks; ++i) {
      // With b's edge upwards, along y.
      const double up_m = std::numbers::sqrt2 * kHalf_m + kGap_m;
      const Vec3d middle_m{0.004 * i / kTicks - 0.002, 0.003 * i / kTicks,
                           std::numbers::sqrt2 * kHalf_m + up_m};
      const Vec3d place_m{0, middle_m.y - std::tan(aside) * middle_m.x, up_m - kGap_m / 2};
      const Mat3d turned = rotation(back);
      const TickResult r = at({turned * middle_m, back * across * turn({kEighth, 0, 0})});
      EXPECT_LT(norm(r.wrench.force_N - force_N * up), 1e-3 * force_N) << i;
      const Vec3d torque_Nm = cross(turned * (place_m - middle_m), force_N * up);
      EXPECT_LT(norm(r.wrench.torque_Nm - torque_Nm), 0.06e-3 * force_N) << i;
    }
  }
}

TEST_P(AnalyticScene, peg_between_opposed_walls) {
  constexpr double kHalf_m = 0.01, kClearance_m = 0.2e-3;
  bake::Mesh below, above;
  const double off_m = kHalf_m + kClearance_m + 0.01;
  append(below, box(0.03, 0.03, 0.01), 0, 0, -off_m);
  append(above, box(0.03, 0.03, 0.01), 0, 0, off_m);
  const BakedBody peg = body(box(kHalf_m, kHalf_m, kHalf_m)), floor = body(below),
                  lid = body(above);
  load({&peg, &floor, &lid});
  const TickResult centred = at({});
  const double side_N = spring_N(kClearance_m);
  EXPECT_LT(norm(centred.wrench.force_N), kRelative * side_N);
  double pressed_N = 0;
  for (const Contact& c : centred.contacts) {
    pressed_N += c.weight * kStiffness_N_per_m * (kDelta_m - c.distance_m);
  }
  EXPECT_NEAR(pressed_N, 2 * side_N, kRelative * side_N);  // none cancelled before it was counted
  EXPECT_EQ(centred.clusters, 2u);
  for (const double off_centre_m : {0.05e-3, -0.15e-3}) {
    expect_force(at({{0, 0, off_centre_m}, {}}), {0, 0, -2 * kStiffness_N_per_m * off_centre_m});
  }
}

INSTANTIATE_TEST_SUITE_P(Engine, LevelsScene, testing::Values(EngineKind::levels),
                         [](const auto&) { return "levels"; });
INSTANTIATE_TEST_SUITE_P(Engine, RegionsScene, testing::Values(EngineKind::regions),
                         [](const auto&) { return "regions"; });
INSTANTIATE_TEST_SUITE_P(Engines, AnalyticScene,
                         testing::Values(EngineKind::levels, EngineKind::regions),
                         [](const auto& tested) {
                           return tested.param == EngineKind::levels ? "levels" : "regions";
                         });

}  // namespace
}  // namespace palpate::test

// SPDX-License-Identifier: GPL-3.0-or-later
// Overlaps of detailed surfaces: which way they push, and that they do not kick.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "host_bake/models/models.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

constexpr double kStiffness_N_per_m = 500;

Settings settings(double delta_m) {
  return {.engine = EngineKind::regions,
          .delta_m = delta_m,
          .exact = true,
          .stiffness_N_per_m = kStiffness_N_per_m,
          .cluster_radius_m = delta_m};
}

/// Without stiffness an exact query asks for distances alone: to place a body by.
Settings distances(double delta_m) {
  Settings out = settings(delta_m);
  out.stiffness_N_per_m = 0;
  return out;
}

BakedBody baked(bake::Mesh mesh, double delta_rel) {
  bake::BakeOptions options = options_for(bake::ForEngine::regions);
  options.delta_rel = delta_rel;
  return {std::move(mesh), options};
}

/// One ball about another, always in overlap by 0.2 delta.
struct Slide {
  Slide(bake::Mesh moved, bake::Mesh fixed, double delta)
      : delta_m(delta),
        a(baked(std::move(moved), delta)),
        b(baked(std::move(fixed), delta)),
        scene({a.view, b.view}, {{0, 1}}, settings(delta)),
        wide({a.view, b.view}, {{0, 1}}, distances(2 * delta)) {}

  static Vec3d out_at(double angle) {
    const Vec3d out{std::sin(angle), 0.2, std::cos(angle)};
    return (1 / norm(out)) * out;
  }

  Pose pose_at(double angle) {
    const Vec3d out = out_at(angle);
    const double touch = 0.1 * delta_m;
    double reach = 2.3;
    Pose pose{reach * out, turn({0.3, 0.2, 0.1})};
    for (int i = 0; i < 30; ++i) {
      const Pose poses[2] = {pose, {}};
      const TickResult r = tick_or_fail(*wide.engine, poses);
      reach -= (r.contacts.empty() ? 2 * delta_m : r.min_distance_m) - touch;
      pose.position_m = reach * out;
    }
    pose.position_m = (reach - touch - 0.2 * delta_m) * out;
    return pose;
  }

  double delta_m;
  BakedBody a, b;
  BakedScene scene, wide;
};

/// Largest change of force from tick to tick over the way of the tool, in stiffnesses.
double largest_step(Slide& slide, double from, double to) {
  constexpr double kStep = 1e-4;
  double largest = 0;
  Vec3d force_before_N;
  Vec3d position_before_m;
  bool first = true;
  for (double angle = from; angle < to; angle += kStep) {
    const Pose poses[2] = {slide.pose_at(angle), {}};
    const TickResult r = tick_or_fail(*slide.scene.engine, poses);
    EXPECT_LT(r.min_distance_m, 0) << angle;
    for (const Contact& c : r.contacts) {
      EXPECT_GT(dot(c.normal, Slide::out_at(angle)), 0) << angle << ": " << c.distance_m;
    }
    if (!first) {
      const double moved_m = norm(poses[0].position_m - position_before_m);
      const double changed_N = norm(r.wrench.force_N - force_before_N);
      largest = std::max(largest, changed_N / (kStiffness_N_per_m * moved_m));
    }
    first = false;
    force_before_N = r.wrench.force_N;
    position_before_m = poses[0].position_m;
  }
  return largest;
}

/// A wall alone would be 1, by the definition of stiffness. Where the deepest piece of an overlap
/// told the direction, this was 400.
TEST(RegionsOverlap, force_does_not_kick_where_pieces_are_thinner_than_it_is_deep) {
  Slide slide(ball(30, 40, 1), bumpy_ball(60, 80, 1), 0.1);
  EXPECT_LT(largest_step(slide, 0.34, effort(0.37, 0.345)), 80);
}

/// Four sides of different slopes, each in a piece of its own; the corner at the origin.
bake::Mesh crooked_pyramid() {
  bake::Mesh m;
  m.points = {{0, 0, 0}, {0.3, 0.1, 0.5}, {0, 0.6, 0.5}, {-0.9, 0, 0.5}, {0, -0.2, 0.5}};
  m.faces = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}};
  return m;
}

void expect_pushed_along(const BakedBody& a, const BakedBody& b, Vec3d out) {
  BakedScene scene({a.view, b.view}, {{0, 1}}, settings(0.02));
  for (const double depth_m : {-1e-3, -1e-5, 1e-5, 1e-4, 1e-3}) {
    const Pose poses[2] = {{-depth_m * out, {}}, {{}, {}}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    ASSERT_FALSE(r.contacts.empty());
    EXPECT_NEAR(r.min_distance_m, -depth_m, 2e-6);
    for (const Contact& c : r.contacts) {
      if (c.weight == 0) continue;
      EXPECT_GT(dot(c.normal, out), 0.9999) << depth_m;
      EXPECT_LT(norm(c.point_a_m), 4e-3) << depth_m;
    }
  }
}

/// Each side sees a part of the curve only, and is pushed as before it crossed.
TEST(RegionsOverlap, corner_in_a_face_is_pushed_along_its_normal_before_and_after) {
  const BakedBody corner = baked(crooked_pyramid(), 0.02);
  bake::Mesh plate;
  append(plate, box(3, 3, 0.5), 0.1, 0.2, -0.5);
  const BakedBody face = baked(std::move(plate), 0.02);
  expect_pushed_along(corner, face, {0, 0, 1});
  expect_pushed_along(face, corner, {0, 0, -1});
}

/// Jaws in bite, ground to and fro between 0.2 mm apart and 0.2 mm deep.
std::vector<Pose> ground(BakedScene& scene, double delta_m) {
  std::vector<Pose> path;
  double height_m = 0.0015;
  for (int t = 0; t < effort(1000, 300); ++t) {
    const Pose poses[2] = {
        {{1e-3 * std::sin(0.004 * t), 1e-3 * std::sin(0.0061 * t), height_m}, {}}, {}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    const double distance_m = r.contacts.empty() ? delta_m : r.min_distance_m;
    height_m -= std::clamp(distance_m - 2e-4 * std::cos(0.01 * t), -3e-5, 3e-5);
    path.push_back(poses[0]);
  }
  return path;
}

std::vector<Vec3d> forces_along(const std::vector<Pose>& path, BakedScene& scene) {
  std::vector<Vec3d> forces_N;
  for (const Pose& pose : path) {
    const Pose poses[2] = {pose, {}};
    forces_N.push_back(tick_or_fail(*scene.engine, poses).wrench.force_N);
  }
  return forces_N;
}

double largest(const std::vector<Vec3d>& forces_N) {
  double most_N = 0;
  for (const Vec3d& force_N : forces_N) most_N = std::max(most_N, norm(force_N));
  return most_N;
}

/// Root mean square of the difference over the largest of the first ones.
double difference(const std::vector<Vec3d>& first_N, const std::vector<Vec3d>& other_N) {
  double square_N2 = 0;
  for (std::size_t t = 0; t < first_N.size(); ++t) {
    square_N2 += squared_norm(other_N[t] - first_N[t]) / double(first_N.size());
  }
  return std::sqrt(square_N2) / largest(first_N);
}

/// A region tells its nearest place alone, yet it hardly matters what it is: images for other
/// contact tolerances have regions of other sizes. The first ones are for this one.
TEST(RegionsOverlap, force_hardly_depends_on_how_surfaces_are_divided) {
  constexpr double kDelta_m = 4e-4;
  constexpr double kMostDifference = 0.05;
  std::vector<Pose> path;
  std::vector<Vec3d> first_N;
  std::size_t regions_before = 0;
  for (const double made_for : {0.0114, 0.0076, 0.005}) {
    const BakedBody upper = baked(bake::make_model("jaw_upper", 6000), made_for);
    const BakedBody lower = baked(bake::make_model("jaw_lower", 6000), made_for);
    EXPECT_GT(upper.view.regions.size(), 1.5 * double(regions_before));
    regions_before = upper.view.regions.size();
    BakedScene scene({upper.view, lower.view}, {{0, 1}}, settings(kDelta_m));
    BakedScene placing({upper.view, lower.view}, {{0, 1}}, distances(kDelta_m));
    if (path.empty()) path = ground(placing, kDelta_m);
    const std::vector<Vec3d> forces_N = forces_along(path, scene);
    if (first_N.empty()) first_N = forces_N;
    EXPECT_GT(largest(first_N), 0.1);
    const double differs = difference(first_N, forces_N);
    EXPECT_LT(differs, kMostDifference) << made_for;
    RecordProperty("difference_" + std::to_string(upper.view.regions.size()),
                   std::to_string(differs));
  }
}

/// A screw pushed from all sides in its nut, up to 0.15 delta.
std::vector<Pose> pushed(BakedScene& scene, double delta_m) {
  std::vector<Pose> path;
  for (int k = 0; k < effort(40, 10); ++k) {
    const Vec3d to{std::cos(0.9 * k), std::sin(0.9 * k), std::cos(0.37 * k)};
    double way_m = 0;
    for (double step_m = 0.5 * delta_m; step_m > 1e-3 * delta_m; step_m *= 0.5) {
      for (int more = 0; more < 8; ++more) {
        const Pose poses[2] = {{(way_m + step_m) * to, {}}, {}};
        const TickResult r = tick_or_fail(*scene.engine, poses);
        if (!r.contacts.empty() && r.min_distance_m < 0.15 * delta_m) break;
        way_m += step_m;
      }
    }
    path.push_back({way_m * to, {}});
  }
  return path;
}

/// Both flanks of a thread are near. A region that held two would tell of the nearer one alone.
TEST(RegionsOverlap, both_flanks_of_a_thread_are_felt_where_regions_are_as_wide_as_it) {
  constexpr double kDeltaRel = 0.02;
  constexpr double kMostDifference = 0.1;
  std::vector<Pose> path;
  std::vector<Vec3d> fine_N;
  for (const double made_for : {0.25 * kDeltaRel, kDeltaRel}) {  // half as wide, and as wide
    const BakedBody screw = baked(bake::make_model("screw", 8000), made_for);
    const BakedBody nut = baked(bake::make_model("nut", 8000), made_for);
    const double delta_m = kDeltaRel * nut.view.header->radius_m;
    BakedScene scene({screw.view, nut.view}, {{0, 1}}, settings(delta_m));
    BakedScene placing({screw.view, nut.view}, {{0, 1}}, distances(delta_m));
    if (path.empty()) path = pushed(placing, delta_m);
    const std::vector<Vec3d> forces_N = forces_along(path, scene);
    if (fine_N.empty()) fine_N = forces_N;
    EXPECT_GT(largest(fine_N), 0.5 * kStiffness_N_per_m * delta_m);
    const double differs = difference(fine_N, forces_N);
    EXPECT_LT(differs, kMostDifference) << screw.view.regions.size() << " regions";
    RecordProperty("thread_" + std::to_string(screw.view.regions.size()), std::to_string(differs));
  }
}

}  // namespace
}  // namespace palpate::test

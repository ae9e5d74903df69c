// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/motion_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace palpate::cli {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr double kBall_m = 0.02135;
constexpr double kPitch_m = 0.002;  // of the screw's thread

using Path = Waymark (*)(double share, double phase);

Quat turned(Vec3d axis, double angle_rad) {
  const Vec3d v = (std::sin(angle_rad / 2) / norm(axis)) * axis;
  return {std::cos(angle_rad / 2), v.x, v.y, v.z};
}

double wave(double turns) { return std::sin(kFullTurn * turns); }

/// From slightly below touch to just within the tolerance, `times` over.
double in_contact(double share, double times, double phase) {
  return 0.425 + 0.525 * wave(times * share + phase);
}

/// The same, and off the surface between.
double tapping(double share, double times, double phase) {
  return 0.7 + 0.8 * wave(times * share + phase);
}

Vec3d direction(double azimuth_turns, double height_turns) {
  const double level = std::cos(kFullTurn * height_turns);
  return {level * std::cos(kFullTurn * azimuth_turns), level * wave(azimuth_turns),
          wave(height_turns)};
}

/// Chewing strokes that open sideways, sliding while the teeth are together.
Waymark jaws(double share, double phase) {
  const double strokes = 4 * share;
  Waymark w;
  w.pose.position_m = {0.0012 * wave(strokes / 2 + phase), 0.0006 * wave(strokes + phase), 0.004};
  w.pose.orientation = turned({1, 0.3, 0.5}, 0.012 * wave(strokes / 2 + 2 * phase));
  w.approach = {0, 0, -1};
  w.gap = tapping(share, 4, phase);
  return w;
}

/// Taps of the face, then rolling and sliding on it.
Waymark golf(double share, double phase) {
  Waymark w;
  w.pose.position_m = {0.006 * wave(share + phase), -0.04, -0.007 + 0.004 * wave(1.5 * share)};
  w.pose.orientation =
      turned({wave(share), 0.2, wave(share + 0.3)}, 0.15 * wave(2 * share + phase));
  w.approach = {0, 1, 0};
  // Ten taps a motion, lower ones as it goes on; at the end the face stays on the ball.
  const double lift = std::max(0.0, 1 - 1.6 * share);
  w.gap = in_contact(share, 10, phase) + lift * 0.4 * (1 + wave(10 * share + phase));
  return w;
}

/// Rolls around the other ball while it turns about itself.
Waymark golf_balls(double share, double phase) {
  const Vec3d out = direction(0.6 * share + phase, 0.12 * wave(share + phase));
  Waymark w;
  w.pose.position_m = (2 * kBall_m + 0.002) * out;
  w.pose.orientation = turned({0.3, 0.2, 1}, kFullTurn * (0.5 * share + phase));
  w.approach = -out;
  w.gap = in_contact(share, 5, phase);
  return w;
}

/// Its tip and its flat sides over dimples, by tilting and turning while it slides.
Waymark ellipsoid(double share, double phase) {
  const Vec3d out = direction(0.3 * share + phase, 0.15 + 0.08 * wave(2 * share + phase));
  Waymark w;
  w.pose.position_m = (kBall_m + 0.022) * out;
  w.pose.orientation = turned({1, 0.4 * wave(share), 0.5}, 1.3 * wave(share + phase));
  w.approach = -out;
  w.gap = in_contact(share, 6, phase);
  return w;
}

/// Presses in a turning direction.
void press(Waymark& w, double share, double phase) {
  w.approach = {0.8 * std::cos(kFullTurn * (3 * share + phase)), 0.8 * wave(3 * share + phase),
                wave(share)};
  w.approach = (1 / norm(w.approach)) * w.approach;
  w.gap = in_contact(share, 7, phase);
}

Waymark ball_joint(double share, double phase) {
  Waymark w;
  w.pose.orientation = turned({wave(share + phase), wave(share + phase + 0.25), 0.4},
                              0.05 * wave(2 * share + phase));
  press(w, share, phase);
  w.approach = (1 / norm(w.approach + Vec3d{0, 0, -1.2})) * (w.approach + Vec3d{0, 0, -1.2});
  return w;
}

Waymark ball_shell(double share, double phase) {
  Waymark w;
  w.pose.orientation =
      turned({wave(share + phase), wave(1.5 * share), 1}, 0.0015 * wave(2 * share));
  press(w, share, phase);
  return w;
}

/// A quarter of a turn in and out again, along the thread.
Waymark screw_nut(double share, double phase) {
  const double turns = 0.25 * wave(share + phase);
  Waymark w;
  w.pose.position_m = {0, 0, kPitch_m * turns};
  w.pose.orientation = turned({0, 0, 1}, kFullTurn * turns);
  press(w, share, phase);
  return w;
}

constexpr std::array<Motion, 7> kMotions = {{
    {"jaws", "jaws.toml", "the upper jaw chews and slides on the lower one", Closing::from_outside},
    {"golf", "golf.toml", "the club taps the ball, then rolls and slides on it",
     Closing::from_outside},
    {"golf_balls", "golf_balls.toml", "a golf ball rolls around another", Closing::from_outside},
    {"ball_joint", "ball_joint.toml", "the head turns in its cup under load", Closing::from_inside},
    {"ellipsoid", "ellipsoid_golf.toml", "an ellipsoid explores the dimples of a golf ball",
     Closing::from_outside},
    {"screw_nut", "screw_nut.toml", "the screw is turned in its nut and pushed aside",
     Closing::from_inside},
    {"ball_shell", "ball_shell.toml", "a golf ball is pressed about in a shell that matches it",
     Closing::from_inside},
}};
constexpr std::array<Path, kMotions.size()> kPaths = {jaws,      golf,      golf_balls, ball_joint,
                                                      ellipsoid, screw_nut, ball_shell};

/// SplitMix64 (G. Steele, D. Lea, C. Flood, Fast Splittable Pseudorandom Number Generators, 2014),
/// one number in [0, 1).
double phase_of(std::uint64_t seed) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

std::span<const Motion> motions() { return kMotions; }

Waymark waymark(const Motion& motion, double share, std::uint64_t seed) {
  std::size_t i = 0;
  while (kMotions[i].name != motion.name) ++i;
  return kPaths[i](share, phase_of(seed));
}

}  // namespace palpate::cli

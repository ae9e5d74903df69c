// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/motion_placing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

constexpr double kReach = 3.0;        // of delta: how far the distance is known
constexpr double kReachInside = 1.5;  // of the clearance, where that is less: a part in another is
                                      // never farther, and all that is nearer has to be looked at
constexpr double kPrecision = 0.01;   // of delta
constexpr double kLeastGap = 0.02;    // of delta, that distance queries are used for
constexpr int kMaxSteps = 100;
constexpr double kLeastSlope = 0.25;  // of distance along the approach that a step counts on

config::Scene seeing(const config::Scene& scene, double reach_m) {
  config::Scene out = scene;
  out.settings.engine = EngineKind::regions;
  out.settings.exact = true;
  out.settings.force_tolerance_N = 0;
  out.settings.stiffness_N_per_m = 0;  // distances alone
  out.settings.delta_m = reach_m;
  return out;
}

}  // namespace

MotionPlacing::MotionPlacing(const config::Scene& scene)
    : scene_(scene),
      wide_(seeing(scene, kReach * scene.settings.delta_m)),
      engine_(std::make_unique<SceneEngine>(wide_)),
      poses_(engine_->start_poses()),
      tool_(scene.tool),
      other_(1 - std::min<std::size_t>(scene.tool, 1)) {
  if (scene.bodies.size() != 2) {
    throw Failure(kUsage, "not two bodies", scene.file.string(),
                  "give a scene of the tool and what it touches");
  }
}

Pose MotionPlacing::moved(const Waymark& at, double along_m) const {
  const Pose& frame = scene_.bodies[other_].pose;
  const Vec3d local_m = at.pose.position_m + along_m * at.approach;
  return {frame.position_m + rotation(frame.orientation) * local_m,
          frame.orientation * at.pose.orientation};
}

double MotionPlacing::distance_m(const Waymark& at, double along_m) {
  poses_[tool_] = moved(at, along_m);
  TickResult result;
  const Status status = tick(engine_->engine(), poses_, {}, result);
  if (status != Status::ok) {
    throw Failure(kOther, std::string("the engine failed (") + describe(status) + ")",
                  scene_.file.string(), "check the scene's poses");
  }
  if (!std::isnan(result.min_distance_m)) return result.min_distance_m;
  // Distances alone tell nothing of a body wholly inside the other but that it may be.
  return result.certificate.contact == ContactStatus::ruled_out ? wide_.settings.delta_m : 0;
}

/// The gap where the waymark is; the first one is what is looked as far as from there on.
double MotionPlacing::clearance_m(const Waymark& at) {
  const double gap_m = std::max(0.0, distance_m(at, 0));
  const double reach_m = kReachInside * gap_m;
  if (!narrowed_ && reach_m > 0 && reach_m < wide_.settings.delta_m) {
    engine_.reset();  // first: it refers to the scene
    wide_ = seeing(scene_, reach_m);
    engine_ = std::make_unique<SceneEngine>(wide_);
  }
  narrowed_ = true;
  return gap_m;
}

/// Back along the approach from the last place, farther and farther, until the gap is large enough.
double MotionPlacing::free_place(const Waymark& at, double gap_m) {
  double back_m = 0.25 * scene_.settings.delta_m;
  double along_m = last_m_ - back_m;
  for (int i = 0; i < kMaxSteps && distance_m(at, along_m) < gap_m; ++i) {
    back_m *= 1.5;
    along_m -= back_m;
  }
  return along_m;
}

double MotionPlacing::close(const Waymark& at, double from_m, double gap_m) {
  const double precise_m = kPrecision * scene_.settings.delta_m;
  double free_m = from_m;
  double left_m = distance_m(at, free_m) - gap_m;
  double beyond_m = std::numeric_limits<double>::infinity();  // where the gap is too small
  double slope = 1;
  for (int i = 0; i < kMaxSteps && left_m > precise_m; ++i) {
    if (beyond_m - free_m < 0.1 * precise_m) break;  // the distance jumps here
    double next_m = free_m + left_m / slope;
    if (next_m >= beyond_m) next_m = 0.5 * (free_m + beyond_m);
    const double next_left_m = distance_m(at, next_m) - gap_m;
    if (next_left_m >= 0) {
      slope = std::clamp((left_m - next_left_m) / (next_m - free_m), kLeastSlope, 1.0);
      free_m = next_m;
      left_m = next_left_m;
    } else {
      beyond_m = next_m;
    }
  }
  return free_m;
}

Pose MotionPlacing::place(const Waymark& at, Closing closing) {
  const double delta_m = scene_.settings.delta_m;
  double unit_m = delta_m;
  double from_m = 0;
  if (closing == Closing::from_inside) {
    unit_m = std::min(delta_m, clearance_m(at));
  } else {
    from_m = free_place(at, std::max(at.gap, kLeastGap) * unit_m);
  }
  const double reached = std::max(at.gap, kLeastGap);
  last_m_ = close(at, from_m, reached * unit_m);
  return moved(at, last_m_ + (reached - at.gap) * unit_m);
}

}  // namespace palpate::cli

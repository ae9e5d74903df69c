// SPDX-License-Identifier: Apache-2.0
// Scenes: what a user writes in scene.toml. config/README.md documents every key with unit, range
// and default.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "rt_core/force/coupling.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::config {

/// A scene file is refused. The message reads `WHAT: FILE:LINE: HOW TO FIX`; the command line
/// exits with 2.
struct ConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class Role {
  tool,   ///< held by the device; exactly one
  moved,  ///< moved by recorded poses
  fixed,  ///< stays at its pose
};

struct Body {
  std::string name;
  std::filesystem::path image;  ///< made absolute, relative ones from the scene file's folder
  Role role = Role::fixed;
  Pose pose;  ///< where it is until something moves it
};

using palpate::EngineKind;

/// What the hand feels.
enum class Coupling {
  direct,    ///< the force of the contacts (the paper's)
  virtual_,  ///< a spring to a simulated tool that feels them
};

/// One point of the mock hand's script: where the hand wants the tool at a time.
struct Waypoint {
  double t_s = 0;
  Pose pose;
};

/// The mock device: a simulated hand that holds the tool (a mass on a spring and a damper whose far
/// end follows the path).
struct MockHand {
  double mass_kg = 0.3;
  double inertia_kg_m2 = 1e-4;
  double grip_N_per_m = 300.0;
  double grip_Nm_per_rad = 0.5;
  double damping_N_s_per_m = 5.0;
  double damping_Nm_s_per_rad = 0.01;
  std::vector<Waypoint> path;  ///< first at 0 s, times ascending; starts over after the last one;
                               ///< empty: the tool's pose
};

struct Scene {
  std::filesystem::path file;
  /// [engine] and [force]. Unlike the engine's own defaults the wrench is limited, for a scene may
  /// drive a device.
  Settings settings{.max_force_N = 3.0, .max_torque_Nm = 0.1};
  Limits limits;                ///< [limits]
  std::optional<double> kappa;  ///< absent: no such rule
  bool interpolate = false;     ///< not used any more
  double max_memory_MB =
      1000.0;  ///< [limits], 1 MB = 10^6 bytes: a scene that needs more is refused
  std::optional<double> budget_us;   ///< of one tick; absent: unlimited in replay
  std::optional<double> reserve_us;  ///< beyond that (Budget::reserve_ns); absent: none in replay
  double rate_Hz = 1000.0;           ///< [run]: of the real-time loop
  bool passivity_control = true;     ///< [run]: energy that the loop gives out is taken back
  std::optional<double> device_damping_N_s_per_m;  ///< [run]: of the device and the hand on it
  std::optional<double> contact_rate_Hz;           ///< [run]; absent: every tick asks for contacts
  Coupling coupling = Coupling::direct;            ///< [force]
  double contact_damping_N_s_per_m = 0;            ///< [force]
  double steady_force_N_per_s = 150;               ///< [force], SteadyRates
  double steady_torque_Nm_per_s = 3;               ///< [force], likewise
  double max_force_slew_N_per_s = 2000;            ///< [force], of what is sent
  double max_torque_slew_Nm_per_s = 60;            ///< [force], likewise
  double max_power_W = 5;                          ///< [force], given to the hand
  force::CouplingSettings virtual_tool;            ///< [coupling]
  std::vector<Body> bodies;
  std::vector<BodyPair> pairs;   ///< as written, or the tool against every other body
  std::vector<double> friction;  ///< [pairs], coefficient of Coulomb friction; all 0: none
  std::uint32_t tool = 0;        ///< index into bodies
  MockHand hand;                 ///< [mock]
};

/// Reads and checks a scene file. Not readable, not TOML, unknown keys, wrong types, out-of-range
/// values, two tools or none, unknown or repeated body names, bad quaternions: ConfigError with
/// file, line and what is allowed. Images are not opened.
Scene load_scene(const std::filesystem::path& file);

}  // namespace palpate::config

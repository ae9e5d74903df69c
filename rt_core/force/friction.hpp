// SPDX-License-Identifier: Apache-2.0
// Coulomb friction with stick, beside the contact force and apart from it: a scene without friction
// never comes here.
//
// Source: the displacement form of Dahl's model, V. Hayward and B. Armstrong, A new computational
// model of friction applied to haptic rendering, Experimental Robotics VI, 2000: no velocity and no
// time enters, so noise of readings is not felt. Departure: several contacts of a pair share one
// spring.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/palpate_rt.hpp"

namespace palpate::force {

/// What sticks between the tool and one other body.
struct Stick {
  bool holds = false;  ///< there was contact in the last tick
  Vec3d stretch_m{};   ///< of the tangential spring: how far the tool has come; other's axes
  Pose tool, other;    ///< in the last tick
};

/// Friction of every pair of the tool, after Engine's tick.
///
/// The contacts of a pair push the tool with N newtons, their sizes summed, about the centre of
/// pressure p. There a spring of the contacts' own stiffness k holds the two bodies together:
/// stretched by how the tool's material at p moves over the other body's, freed of what goes along
/// the contacts' normals n_i (its part (I - sum N_i n_i n_i^T / N), which for one normal or two
/// opposed ones is the tangent plane's), and shortened to mu N / k where it would be longer: the
/// contact slips. It gives back no more than it was given: shortening, freeing and lifting off only
/// lose energy. A contact area does not resist spinning about its centre.
class Friction {
 public:
  /// @param coefficients  mu, [pairs], >= 0; 0: that pair is left out
  /// @param sticks        [pairs], empty ones at the start
  Friction(std::span<const double> coefficients, std::span<Stick> sticks) noexcept
      : coefficients_(coefficients), sticks_(sticks) {}

  /// Adds to the wrench, and while it sticks to the stiffness.
  /// @param poses   [bodies] that the tick was asked for; unit quaternions
  /// @param result  of that tick, its wrench not limited
  /// O(contacts + pairs)
  void add(std::span<const BodyPair> pairs, std::uint32_t tool, const Settings& settings,
           std::span<const Pose> poses, TickResult& result) noexcept;

 private:
  std::span<const double> coefficients_;
  std::span<Stick> sticks_;
};

}  // namespace palpate::force

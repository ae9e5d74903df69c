// SPDX-License-Identifier: GPL-3.0-or-later
// A hand that presses on a wall, in virtual time: does it come to rest?
#pragma once

#include <cstdint>

namespace palpate::bench {

/// How the wall reaches the hand.
enum class Felt : std::uint8_t {
  direct,   ///< a penalty spring
  coupled,  ///< a spring to a simulated tool against a wall of kHardWall_N_per_m
};

inline constexpr double kHardWall_N_per_m = 1e6;

struct PressedWall {
  double mass_kg = 0.3;  ///< of the hand
  double damping_N_s_per_m = 2;
  double grip_N_per_m = 300;
  double rate_Hz = 1000;
  int encoder_bits = 20;  ///< over kEncoderSpan_m
  Felt felt = Felt::direct;
  bool passivity_control = false;
  double stiffness_N_per_m = 1000;  ///< of the wall, or of the coupling's spring
};

inline constexpr double kEncoderSpan_m = 0.2;

/// The hand comes from 1 mm outside, presses with a newton and is watched for some seconds; what is
/// computed from a reading is in force one tick later, for one tick. True where it does not swing
/// more than four steps of the encoder in the end, or swings less and less.
[[nodiscard]] bool comes_to_rest(const PressedWall& wall);

/// The bound b / (T / 2 + T) of largest_passive_stiffness() with this delay, N/m.
[[nodiscard]] double passive_stiffness(const PressedWall& wall);

/// Largest stiffness that comes to rest, within 4 %; by halving on a scale of logarithms, so that
/// islands of rest above the first unrest may be missed. Between kLeastStiffness_N_per_m, which is
/// also the answer where nothing rests, and kMostStiffness_N_per_m.
[[nodiscard]] double largest_stable_stiffness(PressedWall wall);

inline constexpr double kLeastStiffness_N_per_m = 10;
inline constexpr double kMostStiffness_N_per_m = 1e5;

}  // namespace palpate::bench

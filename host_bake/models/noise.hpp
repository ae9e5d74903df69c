// SPDX-License-Identifier: GPL-3.0-or-later
// Repeatable randomness: one generator and one smooth noise, the same on every machine.
#pragma once

#include <cstdint>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014: SplitMix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  /// Evenly in [-1, 1).
  double signed_unit();

 private:
  std::uint64_t state_;
};

/// Gradient noise after Perlin, "Improving noise", 2002, with hashed instead of tabulated
/// gradients: smooth (C2), zero mean, about one bump a unit of length, within [-1, 1]. Coordinates
/// within 1e9.
double noise(const Point& at, std::uint64_t seed);

/// `octaves` noises, each of twice the frequency and half the height of the one before; the first
/// of frequency 1. Within [-2, 2], mostly within [-0.6, 0.6].
double fractal_noise(const Point& at, int octaves, std::uint64_t seed);

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/models/noise.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include "host_bake/models/blend.hpp"

namespace palpate::bake {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9E3779B97F4A7C15U;

std::uint64_t scramble(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

using Cell = std::array<std::int64_t, 3>;

/// Dot product of the corner's gradient with the way from the corner to the point.
double corner_value(const Cell& corner, const Point& way, std::uint64_t seed) {
  std::uint64_t hash = seed;
  for (const std::int64_t c : corner) {
    hash = scramble(hash + kGoldenGamma + static_cast<std::uint64_t>(c));
  }
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // 21 bits an axis.
    const auto bits = static_cast<double>((hash >> (21U * axis)) & 0x1FFFFFU);
    sum += (bits / 1048576.0 - 1.0) * way[axis];
  }
  return sum;
}

}  // namespace

std::uint64_t Random::next() { return scramble(state_ += kGoldenGamma); }

double Random::signed_unit() {
  return static_cast<double>(next() >> 11U) / 4503599627370496.0 - 1.0;  // 53 bits, 2^52
}

double noise(const Point& at, std::uint64_t seed) {
  Cell cell{};
  Point way{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double floor = std::floor(at[axis]);
    cell[axis] = static_cast<std::int64_t>(floor);
    way[axis] = at[axis] - floor;
  }
  double sum = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Cell c = cell;
    Point w = way;
    double share = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool far = ((corner >> axis) & 1U) != 0;
      const double step = smooth_step(0.0, 1.0, way[axis]);
      share *= far ? step : 1.0 - step;
      c[axis] += far ? 1 : 0;
      w[axis] -= far ? 1.0 : 0.0;
    }
    sum += share * corner_value(c, w, seed);
  }
  return sum;
}

double fractal_noise(const Point& at, int octaves, std::uint64_t seed) {
  double sum = 0.0;
  double frequency = 1.0;
  for (int octave = 0; octave < octaves; ++octave) {
    const Point p{at[0] * frequency, at[1] * frequency, at[2] * frequency};
    sum += noise(p, seed + static_cast<std::uint64_t>(octave)) / frequency;
    frequency *= 2.0;
  }
  return sum;
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
// An iron: a tube along a bent spine whose section turns from a circle (hosel) into a wedge
// (blade). Millimetres inside.
#include <algorithm>
#include <cmath>

#include "host_bake/models/blend.hpp"
#include "host_bake/models/loft.hpp"
#include "host_bake/models/noise.hpp"
#include "host_bake/models/shapes.hpp"
#include "host_bake/models/spine.hpp"
#include "host_bake/models/trig.hpp"

namespace palpate::bake {
namespace {

// Along the spine: hosel, bend, blade.
constexpr double kLength_mm = 130.0;
constexpr double kBendStart_mm = 28.0;
constexpr double kBendEnd_mm = 58.0;  // long enough for a radius above the section's half height
constexpr double kLieTurns = 62.0 / 360.0;
constexpr double kTopCap_mm = 2.0;
constexpr double kToeCap_mm = 20.0;

constexpr double kHoselRadius_mm = 6.5;
constexpr double kHeelHalfHeight_mm = 11.0;
constexpr double kToeHalfHeight_mm = 25.0;
constexpr double kHalfThickness_mm = 4.5;
constexpr double kWedge =
    0.45;  // the sole is thicker than the middle by this share, the top line thinner

constexpr double kGrooveSpacing_mm = 4.0;
constexpr double kGrooveHalfWidth_mm = 1.3;
constexpr double kGrooveDepth_mm = 0.6;
constexpr double kCavityDepth_mm = 1.8;
constexpr double kRoughness = 0.05;  // of the thickness
constexpr double kRoughnessBump_mm = 2.5;

/// 1 inside (low, high), 0 outside, ramps of `ramp` centred on both ends.
double window(double low, double high, double ramp, double x) {
  return smooth_step(low - ramp, low + ramp, x) * (1.0 - smooth_step(high - ramp, high + ramp, x));
}

/// What is constant along one section.
struct Section {
  double s_mm;
  double blade;  // 0: hosel, 1: blade
  double half_height_mm, half_thickness_mm;
  double shift_mm;  // of the middle, so that the sole is straight
  double size;      // shrinks to 0 at the ends
};

Section section_at(double s_mm) {
  const double blade = smooth_step(kBendStart_mm, kBendEnd_mm + 12.0, s_mm);
  const double growth = smooth_step(kBendEnd_mm - 10.0, kLength_mm + 10.0, s_mm);
  const double blade_height = mix(kHeelHalfHeight_mm, kToeHalfHeight_mm, growth);
  Section c{};
  c.s_mm = s_mm;
  c.blade = blade;
  c.half_height_mm = mix(kHoselRadius_mm, blade_height, blade);
  c.half_thickness_mm = mix(kHoselRadius_mm, kHalfThickness_mm, blade);
  c.shift_mm = blade * (blade_height - kHeelHalfHeight_mm);
  c.size = round_end(s_mm / kTopCap_mm) * round_end((kLength_mm - s_mm) / kToeCap_mm);
  return c;
}

/// V-shaped grooves along the face, heights counted from the sole.
double groove_mm(const Section& c, double height_mm) {
  const double off = height_mm - kGrooveSpacing_mm * std::floor(height_mm / kGrooveSpacing_mm);
  const double away = std::abs(off - 0.5 * kGrooveSpacing_mm);
  const double profile = smooth_max(1.0 - away / kGrooveHalfWidth_mm, 0.0, 0.3);
  return kGrooveDepth_mm * profile * window(72.0, 112.0, 4.0, c.s_mm);
}

/// Across (towards the top line) and out of the face, millimetres, relative to the spine.
struct Offset {
  double up_mm, out_mm;
};

Offset section_point(const Section& c, double u, std::uint64_t seed) {
  // Fewer vertices go to the narrow edges (angles 0 and 1/2) than to face and back.
  const double angle = u + 0.6 * c.blade * sin_turns(2.0 * u) / 12.566370614359172;
  const double x = cos_turns(angle);
  const double y = sin_turns(angle);
  const double squircle = 1.0 / std::sqrt(std::sqrt(fourth(x) + fourth(y)));
  const double rho = mix(1.0, squircle, c.blade);
  const double up = rho * x;
  const double height_mm = c.half_height_mm * up * c.size;

  double out_mm = c.half_thickness_mm * rho * y * (1.0 - c.blade * kWedge * up) * c.size;
  const double flat = c.blade * c.size * window(-0.75, 0.75, 0.15, up);
  if (y > 0.0) {
    out_mm -= flat * groove_mm(c, height_mm + c.half_height_mm);
  } else {
    const double cavity = window(-0.3, 0.55, 0.2, up) * window(74.0, 112.0, 8.0, c.s_mm);
    const Point at{c.s_mm / kRoughnessBump_mm, height_mm / kRoughnessBump_mm, 0.0};
    out_mm += flat * kCavityDepth_mm * cavity;
    out_mm *= 1.0 + kRoughness * c.blade * fractal_noise(at, 3, seed);
  }
  return {c.shift_mm * c.size + height_mm, out_mm};
}

}  // namespace

Mesh golf_club(std::size_t triangles, std::uint64_t seed) {
  const Spine spine(
      [](double s_mm) {
        return -kLieTurns * (1.0 - smooth_step(kBendStart_mm, kBendEnd_mm, s_mm));
      },
      kLength_mm);
  // The origin lies inside the blade.
  const SpinePoint centre = spine.at(0.7 * kLength_mm);
  const Surface surface = [&](double s_mm) -> Curve {
    return [&, seed, at = spine.at(s_mm), c = section_at(s_mm)](double u) {
      const Offset o = section_point(c, u, seed);
      return Point{0.001 * (at.x - centre.x - at.ty * o.up_mm), 0.001 * o.out_mm,
                   0.001 * (at.y - centre.y + at.tx * o.up_mm)};
    };
  };
  const std::vector<Row> rows = plan_body(surface, 0.0, kLength_mm, triangles / 2 + 2);
  return loft(surface, rows, Ends::poles);
}

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/models/jaw_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_bake/models/blend.hpp"
#include "host_bake/models/noise.hpp"
#include "host_bake/models/trig.hpp"

namespace palpate::bake {
namespace {

constexpr double kClearance_mm = 0.27;

// The common surface.
constexpr double kOverbite_mm = 2.3;       // half of it
constexpr double kOverbiteWidth_mm = 1.3;  // steepness: slope kOverbite / kOverbiteWidth
constexpr double kFrontEnd_mm = 15.0, kCheekStart_mm = 23.0;
constexpr double kCusp_mm = 1.1;  // half the height from fossa to cusp
constexpr double kCuspSpacing_mm = 5.6;
constexpr double kFirstCusp_mm = 35.1;  // on the first molar
constexpr double kCuspRows_mm = 4.6;    // between the inner and the outer row
constexpr double kFissure_mm = 0.15;
constexpr double kFissureBump_mm = 2.2;

// Crowns: what a tooth would fill if there were no other jaw.
constexpr double kCrownTop_mm = 3.4;
constexpr double kEmbrasure_mm = 5.5;  // fall from the middle of a tooth to its neighbour

// Gums.
constexpr double kGum_mm = 7.0;  // below the bite
constexpr double kPapilla_mm = 1.6;
constexpr double kRoot_mm = 0.5;
constexpr double kStipple_mm = 0.2;
constexpr double kStippleBump_mm = 2.0;

struct Tooth {
  double width_mm;       // along the arch
  double half_depth_mm;  // across it
  double offset_mm;      // of the middle, outwards
};
using HalfArch = std::array<Tooth, 7>;

constexpr HalfArch kLowerTeeth{{{5.4, 2.9, -1.3},
                                {5.9, 3.0, -1.3},
                                {6.9, 3.6, -1.0},
                                {7.0, 4.0, -0.5},
                                {7.1, 4.2, -0.4},
                                {11.2, 5.2, -0.4},
                                {10.7, 5.1, -0.4}}};
constexpr HalfArch kUpperTeeth{{{8.6, 3.1, 1.3},
                                {6.6, 3.0, 1.3},
                                {7.6, 3.7, 1.0},
                                {7.1, 4.4, 0.5},
                                {6.6, 4.4, 0.4},
                                {10.4, 5.4, 0.4},
                                {9.8, 5.3, 0.4}}};

double noise_at(BandPlace at, double bump_mm, std::uint64_t seed) {
  return noise({at.s_mm / bump_mm, at.t_mm / bump_mm, 0.5}, seed);
}

/// The common surface: an S across the arch in front, a checkerboard of cusps behind.
double bite_z(BandPlace at, std::uint64_t seed) {
  const double across = at.t_mm / kOverbiteWidth_mm;
  const double front = -kOverbite_mm * across / std::sqrt(1.0 + across * across);
  const double along = (std::abs(at.s_mm) - kFirstCusp_mm) / kCuspSpacing_mm;
  const double cheek = -kCusp_mm * cos_turns(along) * sin_turns(at.t_mm / (2.0 * kCuspRows_mm));
  const double share = smooth_step(kFrontEnd_mm, kCheekStart_mm, std::abs(at.s_mm));
  return mix(front, cheek, share) + kFissure_mm * share * noise_at(at, kFissureBump_mm, seed);
}

/// Half the clearance, taken vertically: more where the common surface is steep.
double half_gap(BandPlace at, std::uint64_t seed) {
  constexpr double kStep_mm = 0.05;
  const double ds =
      bite_z({at.s_mm + kStep_mm, at.t_mm}, seed) - bite_z({at.s_mm - kStep_mm, at.t_mm}, seed);
  const double dt =
      bite_z({at.s_mm, at.t_mm + kStep_mm}, seed) - bite_z({at.s_mm, at.t_mm - kStep_mm}, seed);
  return 0.5 * kClearance_mm * std::sqrt(1.0 + (ds * ds + dt * dt) / square(2.0 * kStep_mm));
}

/// Height of crowns and gums towards the other jaw.
double body_height(const HalfArch& teeth, BandPlace at, std::uint64_t seed) {
  const double along = std::abs(at.s_mm);
  double crowns = -1e3;
  double start = 0.0;
  double neck = 0.0;  // 1 between two teeth, 0 in the middle of one
  for (const Tooth& tooth : teeth) {
    const double xi = (along - start) / tooth.width_mm * 2.0 - 1.0;
    const double eta = (at.t_mm - tooth.offset_mm) / tooth.half_depth_mm;
    const double fall = kEmbrasure_mm * fourth(xi) + 1.5 * square(eta) + 7.0 * fourth(eta);
    crowns = std::max(crowns, kCrownTop_mm - fall);
    if (std::abs(xi) <= 1.0) neck = square(xi);
    start += tooth.width_mm;
  }
  const double aside = smooth_step(3.0, 6.0, std::abs(at.t_mm));
  const double gums = -kGum_mm - 0.04 * square(at.t_mm) + kPapilla_mm * neck * (1.0 - aside) +
                      kRoot_mm * (1.0 - 2.0 * neck) * aside +
                      kStipple_mm * noise_at(at, kStippleBump_mm, seed);
  return smooth_max(crowns, gums, 0.8);
}

}  // namespace

double biting_z_mm(Jaw jaw, BandPlace at, std::uint64_t seed) {
  const double towards = jaw == Jaw::lower ? 1.0 : -1.0;
  const HalfArch& teeth = jaw == Jaw::lower ? kLowerTeeth : kUpperTeeth;
  const std::uint64_t gum_seed = jaw == Jaw::lower ? ~seed : seed + 1;
  const double limit = towards * bite_z(at, seed) - half_gap(at, seed);
  return towards * smooth_min(body_height(teeth, at, gum_seed), limit, 0.5);
}

}  // namespace palpate::bake

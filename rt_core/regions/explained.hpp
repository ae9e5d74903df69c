// SPDX-License-Identifier: Apache-2.0
// Which contacts of unknown direction cannot change a push.
#pragma once

#include "rt_core/contact/facing.hpp"
#include "rt_core/force/constraints.hpp"
#include "rt_core/force/least_push.hpp"

namespace palpate::regions {

/// A push, seen from an axis.
struct PushFromAxis {
  double along = 0;          ///< of its vector
  double across = 0;         ///< of its vector, >= 0
  double squeeze = 0;        ///< of the axis
  double squeeze_aside = 0;  ///< of the squeeze times the axis, what is across it; >= 0
};

inline PushFromAxis seen_from(const force::Push& push, Vec3d axis) noexcept {
  PushFromAxis out;
  out.along = dot(axis, push.vector);
  const Vec3d across = push.vector - out.along * axis;
  out.across = norm(across);
  const Vec3d squeezed = push.squeezed(axis);
  out.squeeze = dot(axis, squeezed);
  out.squeeze_aside = norm(squeezed - out.squeeze * axis);
  return out;
}

/// Least push over all directions within an angle of the axis, or less.
/// @param cosine, sine  of the angle, 0 to pi
inline double least_in_cone(const PushFromAxis& p, double cosine, double sine) noexcept {
  const double size = sqrt_of(p.along * p.along + p.across * p.across);
  const bool opposed = p.along <= -size * cosine;
  const double linear = opposed ? -size : p.along * cosine - p.across * sine;
  if (cosine <= 0) return linear;
  const double squeezed = cosine * (p.squeeze * cosine - 2 * p.squeeze_aside * sine);
  return linear + (squeezed > 0 ? squeezed : 0);
}

/// What is asked of contacts that cannot change a push.
struct ExplainedBy {
  const force::Push& push;
  double share = 1;      ///< 1: the push itself; less: this share of it
  double strongest = 0;  ///< of the contacts known: what has faded is short of zero by half of it
};

/// The largest strength of a contact that cannot change the push. Its direction is within
/// kMostTilt_rad of a cone of normals, and the more it tilts from them the more it has faded
/// (force/constraints.hpp).
/// @param axis  of the cone, as a push  @param cosine  of its half angle; -1: all directions
inline double explained(const ExplainedBy& by, Vec3d axis, double cosine) noexcept {
  const auto counted = [&](double pushed) {
    return by.share < 1 ? (pushed > 0 ? by.share * pushed : 0) : pushed;
  };
  const double anywhere = -norm(by.push.vector);
  if (cosine <= -1) return counted(anywhere);
  // Tilts of 1, 2.5, 5, 8, 12, 17, 23, 30, 37, 45 degrees, and what is left at the tilt before.
  constexpr int kSteps = 10;
  constexpr double kCosine[kSteps] = {0.99984769515639127, 0.9990482215818578,  0.99619469809174555,
                                      0.99026806874157036, 0.97814760073380569, 0.95630475596303544,
                                      0.92050485345244037, 0.86602540378443871, 0.79863551004729283,
                                      0.70710678118654757};
  constexpr double kSine[kSteps] = {0.017452406437283512, 0.043619387365336,   0.087155742747658166,
                                    0.13917310096006544,  0.20791169081775934, 0.29237170472273677,
                                    0.39073112848927377,  0.49999999999999994, 0.60181502315204827,
                                    0.70710678118654746};
  constexpr double kWeight[kSteps] = {1,
                                      0.97777777777777775,
                                      0.94444444444444442,
                                      0.88888888888888884,
                                      0.82222222222222219,
                                      0.73333333333333339,
                                      0.62222222222222223,
                                      0.48888888888888893,
                                      0.33333333333333337,
                                      0.17777777777777781};
  const PushFromAxis push = seen_from(by.push, axis);
  const double sine = sqrt_of(cosine * cosine < 1 ? 1 - cosine * cosine : 0);
  const double faded = force::kFadedShare * by.strongest;
  double least = 1e300;
  for (int i = 0; i < kSteps; ++i) {
    const double c = cosine * kCosine[i] - sine * kSine[i];
    const double s = sine * kCosine[i] + cosine * kSine[i];
    // Beyond 180 degrees the cone is everything.
    const double pushed = counted(s < 0 ? anywhere : least_in_cone(push, c, s));
    if (pushed + faded <= 0) return pushed;
    const double whole = (pushed + (1 - kWeight[i]) * faded) / kWeight[i];
    least = whole < least ? whole : least;
  }
  return least;
}

}  // namespace palpate::regions

// SPDX-License-Identifier: Apache-2.0
// The wrench of a set of contacts: the least push gives the force, the contacts that push in nearly
// the same direction give the point where it acts (docs/CONTACT.md).
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/force/least_push.hpp"
#include "rt_core/force/places.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::force {

/// A contact takes part in the torque where it is stronger than this share of the push.
inline constexpr double kTakesPart = 0.5;

/// How far two unit normals push at one place, by the cosine c between them: c^2 (1 + c) / 2. One
/// for equal normals, zero for perpendicular and for opposed ones, nowhere negative; the polynomial
/// of least degree that is so.
constexpr double kinship(double cosine) noexcept { return 0.5 * cosine * cosine * (1 + cosine); }

/// Where a contact pushes the tool. World axes.
struct PushPoint {
  Vec3d arm_m{};    ///< from the tool's origin
  double mass = 0;  ///< of the contact in the torque: set by push_wrench()
  Spot spot;        ///< scratch
};

/// The wrench before limits, and its linear model.
struct PushWrench {
  Wrench wrench;      ///< on the tool, world axes, torque about its origin
  Matrix6 stiffness;  ///< see TickResult::stiffness
  bool places_full = false;
};

/// Shares the push out.
///
/// A carrying contact of multiplier l and normal n pushes with 2 k l along n; the sum is the force
/// 2 k v. It acts at the mean of the points of all contacts, weighted by mass and by kinship with
/// n. A contact's mass is the square of what its strength exceeds half of the push in its direction
/// by, shared among the contacts within cluster_radius_m (places.hpp), so that it does not depend
/// on the tessellation.
///
/// The linear model holds the carrying contacts and their normals: with J_i = [n_i | arm_i x n_i]
/// and G their Gram matrix, 2 k J^T G^-1 J: symmetric, positive semidefinite, and at most 2 k for
/// translations.
/// @param constraints  of the contacts, strengths in metres  @param points  likewise, in their
/// order
/// @param tool         the grid of places turns with it
/// O(contacts * carrying)
PushWrench push_wrench(std::span<const PushConstraint> constraints, const PushResult& push,
                       std::span<PushPoint> points, const Pose& tool, const Settings& settings,
                       Places& places) noexcept;

/// Scaled down to the limits of the settings; directions stay.
Wrench limited(const Wrench& wrench, const Settings& settings) noexcept;

}  // namespace palpate::force

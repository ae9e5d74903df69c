// SPDX-License-Identifier: Apache-2.0
// Contacts into a wrench (Appendix B, steps 3 to 6).
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/force/depths.hpp"
#include "rt_core/force/places.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::force {

/// Scratch of the force stage, borrowed from the engine.
struct Workspace {
  std::span<Felt> felt;        ///< [contacts]
  std::span<Ranked> ranking;   ///< [contacts]
  DeepCells* cells = nullptr;  ///< [1]
  Places copies;               ///< shares a contact among its copies
  Places places;               ///< shares what is felt among contacts within cluster_radius_m
};

/// Width of the grid of copies, as a share of cluster_radius_m: nearer contacts count as one
/// wherever others are.
constexpr double kCopies = 1.0 / 16;

/// The wrench before limits, and what it was made of.
struct Penalty {
  Wrench wrench;             ///< on the tool, world axes, torque about its origin
  Matrix6 stiffness;         ///< see TickResult
  double directions = 0;     ///< sum of the shares: how many directions are felt, at most about 6
  bool places_full = false;  ///< places found no room: nearby contacts there count more than once
};

/// Penalty force of all contacts of the tool.
///
/// Departure from the paper, which gives every cluster of contacts its own force: there the force
/// grows with the number of clusters that a contact area happens to cover, and jumps where a
/// contact crosses the border of one. Here every direction is felt once, as hard as the deepest
/// contact that pushes that way. With d_i = share_i (delta - distance_i), c_ij the cosine
/// between the directions of two contacts and K = kinship(c_ij) (directions.hpp):
///
///     force_i = k D_i m_i / sum_j (K_ij m_j),   D_i = max_j (K_ij d_j),
///
/// where m_i is the contact's share of the places (places.hpp) it lies at, brought with mass d_i^2;
/// of that, contacts that coincide have one part together, so that they do not outweigh others
/// nearby.
/// Hence
/// - one contact gives k d; N coincident ones give the wrench of one;
/// - a wide contact of one normal gives k times its largest depth whatever it is cut into: the
///   force follows the field of least distance, level by level;
/// - the stiffness of the display does not grow with the number of contacts: all normals around
///   count as the six faces of a box, 2 k along any line;
/// - opposed normals have no kinship: each side keeps its force, and what cancels is their sum; to
///   less than 1e-12 of all forces it cancels wholly, for that is rounding;
/// - a peg that rests on both ends is pushed k d in all, at the mean of the ends weighted by d^2:
///   turned by a small angle, it gets back the torque of two springs of k, one at each end;
/// - a contact that comes within delta brings nothing at first, and everything is continuous in
///   distances, normals and points, and independent of the order of contacts but for rounding.
/// The torque is that of the forces at the contacts' centres (Contact::centre_m).
/// Contacts with every body count together: it does not matter how the surroundings are cut up.
///
/// Sets Contact::weight, 0 for pairs without the tool. O(n log n). No memory of its own.
Penalty penalty(std::span<Contact> contacts, std::span<const BodyPair> pairs, std::uint32_t tool,
                const Pose& tool_pose, const Settings& settings, Workspace& workspace) noexcept;

/// Scaled down to the limits of the settings; directions stay.
Wrench limited(const Wrench& wrench, const Settings& settings) noexcept;

}  // namespace palpate::force

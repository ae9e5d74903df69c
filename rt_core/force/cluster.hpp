// SPDX-License-Identifier: Apache-2.0
// Contacts into clusters, clusters into a wrench (Appendix B, steps 3 to 6).
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/palpate_rt.hpp"

namespace palpate::force {

/// A group of contacts that is felt as one, by its representative: the contact of least distance.
struct Cluster {
  Vec3d point_m{};  ///< between the representative's points
  Vec3d normal{};   ///< the representative's
  std::uint32_t pair = 0;
  std::uint32_t contact = 0;  ///< index of the representative
};

/// A contact waiting for its cluster.
struct Ranked {
  double distance_m = 0;
  std::uint32_t contact = 0;
};

/// Groups the contacts of each pair: in order of distance, a contact joins a cluster of its pair
/// whose representative is within radius_m and whose normal is within 60 degrees of its own; else
/// it founds one. Opposed normals never share a cluster, so that they cannot average to nothing.
/// The representative is the contact of least distance: the average weighted by distance that the
/// paper names depends on how many pieces a surface is cut into, the least distance does not.
/// Sets Contact::weight: 1 for representatives, 0 for the others.
///
/// @param ranking  scratch, [contacts]
/// @param out           [most clusters]; where they are used up, the nearest contacts have theirs
///                      and farther ones add no force
/// @param out_overflow  whether that was so
/// Returns the number of clusters. Independent of the order of the contacts up to exact ties in
/// distance. Cost: O(n log n + n * clusters). No memory.
std::uint32_t cluster(std::span<Contact> contacts, double radius_m, std::span<Ranked> ranking,
                      std::span<Cluster> out, bool& out_overflow) noexcept;

/// Penalty force of every cluster at its representative: k (delta - distance) along the normal, so
/// that N coincident contacts give the wrench of one. On the tool, torque about tool_origin_m;
/// scaled down to the limits of the settings. Pairs without the tool contribute nothing.
Wrench penalty_wrench(std::span<const Contact> contacts, std::span<const Cluster> clusters,
                      std::span<const BodyPair> pairs, std::uint32_t tool, Vec3d tool_origin_m,
                      const Settings& settings) noexcept;

}  // namespace palpate::force

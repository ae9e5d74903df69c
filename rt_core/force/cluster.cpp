// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/cluster.hpp"

#include "rt_core/base/queue.hpp"

namespace palpate::force {
namespace {

constexpr double kSameSideCosine = 0.5;  // 60 degrees

struct Nearer {
  bool operator()(const Ranked& a, const Ranked& b) const noexcept {
    return a.distance_m < b.distance_m || (a.distance_m == b.distance_m && a.contact < b.contact);
  }
};

Vec3d middle(const Contact& c) noexcept { return 0.5 * (c.point_a_m + c.point_b_m); }

/// Length at most `most`; the direction stays.
Vec3d limited(Vec3d v, double most) noexcept {
  const double length = norm(v);
  return length > most ? (most / length) * v : v;
}

bool has_home(const Cluster& candidate, std::span<const Cluster> clusters,
              double radius_m) noexcept {
  const double radius2 = radius_m * radius_m;
  for (const Cluster& c : clusters) {
    if (squared_norm(candidate.point_m - c.point_m) <= radius2 && c.pair == candidate.pair &&
        dot(c.normal, candidate.normal) > kSameSideCosine) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::uint32_t cluster(std::span<Contact> contacts, double radius_m, std::span<Ranked> ranking,
                      std::span<Cluster> out, bool& out_overflow) noexcept {
  MinQueue<Ranked, Nearer> queue(ranking);
  for (std::uint32_t i = 0; i < contacts.size(); ++i) {
    contacts[i].weight = 0;
    queue.push({contacts[i].distance_m, i});
  }
  std::uint32_t clusters = 0;
  out_overflow = false;
  for (; !queue.empty(); queue.pop()) {
    const std::uint32_t index = queue.top().contact;
    Contact& c = contacts[index];
    const Cluster candidate{middle(c), c.normal, c.pair, index};
    if (has_home(candidate, out.first(clusters), radius_m)) continue;
    if (clusters == out.size()) {
      out_overflow = true;
      break;
    }
    out[clusters++] = candidate;
    c.weight = 1;
  }
  return clusters;
}

Wrench penalty_wrench(std::span<const Contact> contacts, std::span<const Cluster> clusters,
                      std::span<const BodyPair> pairs, std::uint32_t tool, Vec3d tool_origin_m,
                      const Settings& settings) noexcept {
  Wrench wrench;
  for (const Cluster& cluster : clusters) {
    const Contact& c = contacts[cluster.contact];
    const BodyPair& pair = pairs[c.pair];
    if (pair.a != tool && pair.b != tool) continue;
    const double size = settings.stiffness_N_per_m * (settings.delta_m - c.distance_m);
    const Vec3d force = (pair.a == tool ? size : -size) * c.normal;
    wrench.force_N += force;
    wrench.torque_Nm += cross(cluster.point_m - tool_origin_m, force);
  }
  wrench.force_N = limited(wrench.force_N, settings.max_force_N);
  wrench.torque_Nm = limited(wrench.torque_Nm, settings.max_torque_Nm);
  return wrench;
}

}  // namespace palpate::force

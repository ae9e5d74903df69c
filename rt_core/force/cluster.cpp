// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/cluster.hpp"

#include "rt_core/base/queue.hpp"

namespace palpate::force {
namespace {

constexpr double kSameSideCosine = 0.5;  // 60 degrees

struct NearerContact {
  std::span<const Contact> contacts;
  bool operator()(std::uint32_t i, std::uint32_t j) const noexcept {
    const double a = contacts[i].distance_m;
    const double b = contacts[j].distance_m;
    return a < b || (a == b && i < j);
  }
};

Vec3d middle(const Contact& c) noexcept { return 0.5 * (c.point_a_m + c.point_b_m); }

/// Length at most `most`; the direction stays.
Vec3d limited(Vec3d v, double most) noexcept {
  const double length = norm(v);
  return length > most ? (most / length) * v : v;
}

/// The cluster that a contact joins, or `count`.
std::uint32_t home_of(const Contact& c, std::span<const Contact> contacts,
                      std::span<const Cluster> clusters, double radius_m) noexcept {
  const auto count = static_cast<std::uint32_t>(clusters.size());
  std::uint32_t best = count;
  double best2 = radius_m * radius_m;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Contact& representative = contacts[clusters[k].contact];
    const double d2 = squared_norm(middle(c) - clusters[k].point_m);
    if (d2 <= best2 && representative.pair == c.pair &&
        dot(representative.normal, c.normal) > kSameSideCosine) {
      best = k;
      best2 = d2;
    }
  }
  return best;
}

}  // namespace

std::uint32_t cluster(std::span<Contact> contacts, double radius_m, std::span<std::uint32_t> order,
                      std::span<Cluster> out) noexcept {
  MinQueue<std::uint32_t, NearerContact> queue(order, NearerContact{contacts});
  for (std::uint32_t i = 0; i < contacts.size(); ++i) {
    contacts[i].weight = 0;
    queue.push(i);
  }
  std::uint32_t clusters = 0;
  for (; !queue.empty(); queue.pop()) {
    Contact& c = contacts[queue.top()];
    if (clusters == out.size())
      break;  // what is left is farther than every representative: it adds no force of its own
    if (home_of(c, contacts, out.first(clusters), radius_m) < clusters) continue;
    out[clusters++] = {queue.top(), middle(c)};
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

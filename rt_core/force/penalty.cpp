// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/penalty.hpp"

#include "rt_core/geometry/directions.hpp"

namespace palpate::force {
namespace {

Vec3d limited(Vec3d v, double most) noexcept {
  const double length = norm(v);
  return length > most ? (most / length) * v : v;
}

/// What forces leave of each other that add up to `all`: nothing, where that is rounding.
Vec3d unless_cancelled(Vec3d sum, double all) noexcept {
  constexpr double kRounding = 1e-12;
  return norm(sum) <= kRounding * all ? Vec3d{} : sum;
}

/// The contacts that push the tool, in the order of contacts.
std::span<Felt> gather(std::span<Contact> contacts, std::span<const BodyPair> pairs,
                       std::uint32_t tool, Vec3d origin_m, double delta_m,
                       std::span<Felt> out) noexcept {
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < contacts.size(); ++i) {
    Contact& c = contacts[i];
    c.weight = 0;
    const BodyPair& pair = pairs[c.pair];
    const double depth_m = c.share * (delta_m - c.distance_m);
    if ((pair.a != tool && pair.b != tool) || !(depth_m > 0)) continue;
    Felt& felt = out[count++];
    felt.point_m = 0.5 * (c.point_a_m + c.point_b_m) - origin_m;
    felt.direction = pair.a == tool ? c.normal : -c.normal;
    felt.depth_m = depth_m;
    felt.contact = i;
  }
  return out.first(count);
}

/// In the tool's axes the grids turn with the scene.
void weigh(std::span<Felt> felt, const Pose& tool_pose, const Settings& settings,
           Workspace& workspace) noexcept {
  const Mat3d to_tool = transpose(rotation(tool_pose.orientation));
  // In units of delta: squares of lengths in metres may leave the range of double.
  const double per_delta = 1 / settings.delta_m;
  workspace.copies.begin(kCopies * settings.cluster_radius_m, felt.size());
  workspace.places.begin(settings.cluster_radius_m, felt.size());
  for (Felt& f : felt) {
    const double depth = per_delta * f.depth_m;
    f.mass = depth * depth;
    f.spot = workspace.copies.add(to_tool * f.point_m, f.mass, f.mass);
  }
  for (Felt& f : felt) {
    const double part = workspace.copies.share(f.spot, f.mass);
    f.spot = workspace.places.add(to_tool * f.point_m, f.mass, part);
    f.mass = part;
  }
  for (Felt& f : felt) f.mass = workspace.places.share(f.spot, f.mass);
}

}  // namespace

Penalty penalty(std::span<Contact> contacts, std::span<const BodyPair> pairs, std::uint32_t tool,
                const Pose& tool_pose, const Settings& settings, Workspace& workspace) noexcept {
  const std::span<Felt> felt =
      gather(contacts, pairs, tool, tool_pose.position_m, settings.delta_m, workspace.felt);
  weigh(felt, tool_pose, settings, workspace);
  Directions directions;
  for (const Felt& f : felt) directions.add(f.direction, f.mass);
  Depths depths(felt, workspace.ranking, *workspace.cells);

  Penalty out;
  double all_N = 0;
  double farthest2 = 0;
  out.places_full = workspace.copies.full() || workspace.places.full();
  for (const Felt& f : felt) {
    if (!(f.mass > 0)) continue;
    const double around = directions.around(f.direction);
    // At least its own; rounding of masses far larger may say less.
    const double share = around > f.mass ? f.mass / around : 1;
    const double depth_m = share * depths.around(f);
    const double size_N = settings.stiffness_N_per_m * depth_m;
    const Vec3d force_N = size_N * f.direction;
    Contact& contact = contacts[f.contact];
    contact.weight = contact.share * depth_m / f.depth_m;
    const Vec3d arm_m = contact.centre_m - tool_pose.position_m;
    all_N += size_N;
    const double arm2 = squared_norm(arm_m);
    farthest2 = arm2 > farthest2 ? arm2 : farthest2;
    out.directions += share;
    out.wrench.force_N += force_N;
    out.wrench.torque_Nm += cross(arm_m, force_N);
    out.stiffness.add_square(vec6(f.direction, cross(arm_m, f.direction)),
                             settings.stiffness_N_per_m * share);
  }
  out.wrench.force_N = unless_cancelled(out.wrench.force_N, all_N);
  out.wrench.torque_Nm = unless_cancelled(out.wrench.torque_Nm, all_N * sqrt_of(farthest2));
  return out;
}

Wrench limited(const Wrench& wrench, const Settings& settings) noexcept {
  return {limited(wrench.force_N, settings.max_force_N),
          limited(wrench.torque_Nm, settings.max_torque_Nm)};
}

}  // namespace palpate::force

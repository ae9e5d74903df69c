// SPDX-License-Identifier: Apache-2.0
#include "hal/protocol/serial_chain.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::hal::protocol {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadPerBinaryAngle = kPi / 2147483648.0;
constexpr double kMetres = 1e-9;
constexpr double kMicro = 1e-6;

/// Shepperd's method: the component that is largest is found first, so that nothing is divided by a
/// small number.
Quat quaternion_of(const Mat3d& m) noexcept {
  const double xx = m.row0.x, yy = m.row1.y, zz = m.row2.z;
  if (xx + yy + zz > 0) {
    const double s = 2 * std::sqrt(1 + xx + yy + zz);
    return {s / 4, (m.row2.y - m.row1.z) / s, (m.row0.z - m.row2.x) / s, (m.row1.x - m.row0.y) / s};
  }
  if (xx >= yy && xx >= zz) {
    const double s = 2 * std::sqrt(1 + xx - yy - zz);
    return {(m.row2.y - m.row1.z) / s, s / 4, (m.row0.y + m.row1.x) / s, (m.row0.z + m.row2.x) / s};
  }
  if (yy >= zz) {
    const double s = 2 * std::sqrt(1 + yy - xx - zz);
    return {(m.row0.z - m.row2.x) / s, (m.row0.y + m.row1.x) / s, s / 4, (m.row1.z + m.row2.y) / s};
  }
  const double s = 2 * std::sqrt(1 + zz - xx - yy);
  return {(m.row1.x - m.row0.y) / s, (m.row0.z + m.row2.x) / s, (m.row1.z + m.row2.y) / s, s / 4};
}

}  // namespace

SerialChain::SerialChain(std::span<const Joint> joints) noexcept
    : count_(std::min(joints.size(), kMaxJoints)) {
  for (std::size_t i = 0; i < count_; ++i) {
    const Joint& j = joints[i];
    const double alpha_rad = kRadPerBinaryAngle * j.alpha;
    links_[i] = {kMetres * j.a_nm,
                 kMetres * j.d_nm,
                 std::cos(alpha_rad),
                 std::sin(alpha_rad),
                 kRadPerBinaryAngle * j.theta_offset,
                 2 * kPi / j.counts_per_turn,
                 j.zero_counts,
                 j.min_counts,
                 j.max_counts,
                 kMicro * j.max_torque_uNm};
  }
}

bool SerialChain::is_within_ends(const JointCounts& counts) const noexcept {
  bool within = true;
  for (std::size_t i = 0; i < count_; ++i) {
    within = within && counts[i] >= links_[i].min_counts && counts[i] <= links_[i].max_counts;
  }
  return within;
}

std::array<SerialChain::Frame, kMaxJoints> SerialChain::frames(
    const JointCounts& counts) const noexcept {
  std::array<Frame, kMaxJoints> out{};
  Frame base;
  for (std::size_t i = 0; i < count_; ++i) {
    const Link& link = links_[i];
    // Counts are 32 bits: their difference needs more.
    const double turned = static_cast<double>(counts[i]) - link.zero_counts;
    const double theta = link.theta_offset_rad + link.rad_per_count * turned;
    const double c = std::cos(theta), s = std::sin(theta);
    const double ca = link.cos_alpha, sa = link.sin_alpha;
    const Mat3d step{{c, -s, 0}, {s * ca, c * ca, -sa}, {s * sa, c * sa, ca}};
    const Vec3d moved{link.a_m, -sa * link.d_m, ca * link.d_m};
    out[i].origin_m = base.origin_m + base.axes * moved;
    out[i].axes = base.axes * step;
    base = out[i];
  }
  return out;
}

Pose SerialChain::pose(const JointCounts& counts) const noexcept {
  if (count_ == 0) return {};
  const Frame tool = frames(counts)[count_ - 1];
  return {tool.origin_m, quaternion_of(tool.axes)};
}

JointTorques SerialChain::torques(const JointCounts& counts, const Wrench& wrench) const noexcept {
  JointTorques out{};
  if (count_ == 0) return out;
  const auto all = frames(counts);
  const Vec3d tool_m = all[count_ - 1].origin_m;
  double scale = 1;
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec3d axis{all[i].axes.row0.z, all[i].axes.row1.z, all[i].axes.row2.z};
    const Vec3d arm_m = tool_m - all[i].origin_m;
    out[i] = dot(axis, wrench.torque_Nm + cross(arm_m, wrench.force_N));
    const double most = links_[i].max_torque_Nm;
    if (std::abs(out[i]) > most) scale = std::min(scale, most / std::abs(out[i]));
  }
  for (double& torque : out) torque *= scale;
  return out;
}

}  // namespace palpate::hal::protocol

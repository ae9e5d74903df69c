// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/messages.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace palpate::live {
namespace {

// Numbers go out as they lie in memory.
static_assert(std::endian::native == std::endian::little);

constexpr std::uint32_t kLeadKind = 1;
constexpr std::uint32_t kLetGoKind = 2;
constexpr double kUnitWithin = 1e-3;
static_assert(kLeadBytes == kLetGoBytes + 7 * sizeof(double));

template <class T>
void append(std::vector<std::byte>& out, T value) {
  const auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void append_all(std::vector<std::byte>& out, std::initializer_list<double> values) {
  for (const double value : values) append(out, value);
}

void append_pose(std::vector<std::byte>& out, const Pose& pose, Vec3d origin_m) {
  const Vec3d p = pose.position_m - origin_m;
  const Quat& q = pose.orientation;
  append_all(out, {p.x, p.y, p.z, q.x, q.y, q.z, q.w});
}

Pose pose_of_record(const realtime::TraceRecord& r) {
  const auto [w, x, y, z] = r.orientation;
  return {{r.position_m[0], r.position_m[1], r.position_m[2]}, {w, x, y, z}};
}

double bits_of(const Certificate& c) { return (c.truncated() ? 1 : 0) + (c.on_reserve ? 2 : 0); }

}  // namespace

std::optional<hal::mock::Lead> parse_lead(std::span<const std::byte> message) noexcept {
  if (message.size() != kLeadBytes && message.size() != kLetGoBytes) return std::nullopt;
  std::array<std::uint32_t, 2> words{};
  std::memcpy(words.data(), message.data(), kLetGoBytes);
  const bool lets_go = message.size() == kLetGoBytes;
  if (words[0] != (lets_go ? kLetGoKind : kLeadKind) || words[1] != 0) return std::nullopt;
  if (lets_go) return hal::mock::Lead{false, {}};

  std::array<double, 7> v{};
  std::memcpy(v.data(), message.data() + kLetGoBytes, sizeof v);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(std::abs(v[i]) <= kFarthest_m)) return std::nullopt;
  }
  const double length = std::sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6]);
  if (!(std::abs(length - 1) <= kUnitWithin)) return std::nullopt;
  return hal::mock::Lead{
      true, {{v[0], v[1], v[2]}, {v[3] / length, v[4] / length, v[5] / length, v[6] / length}}};
}

std::vector<std::byte> encode_lead(const hal::mock::Lead& lead) {
  std::vector<std::byte> out;
  append(out, lead.held ? kLeadKind : kLetGoKind);
  append(out, std::uint32_t(0));
  const Vec3d& p = lead.to.position_m;
  const Quat& q = lead.to.orientation;
  if (lead.held) append_all(out, {p.x, p.y, p.z, q.w, q.x, q.y, q.z});
  return out;
}

void encode_frame(const Status& status, std::span<const Sample> samples,
                  const realtime::LiveTick& contacts, Vec3d origin_m, std::vector<std::byte>& out) {
  const realtime::TraceRecord& tick = status.tick;
  const Certificate& certificate = contacts.certificate;
  const double now_s = 1e-9 * static_cast<double>(tick.time_ns);
  const auto& rendered_N = tick.rendered_force_N;
  const auto& sent_N = tick.sent_force_N;
  const auto& sent_Nm = tick.sent_torque_Nm;
  out.clear();
  // 0: what follows, and the loop.
  append_all(out, {static_cast<double>(samples.size()), static_cast<double>(contacts.shown),
                   static_cast<double>(contacts.found), status.ended ? 1.0 : 0.0,
                   static_cast<double>(tick.state), static_cast<double>(tick.faults), now_s,
                   static_cast<double>(tick.tick)});
  // 8: deadlines.
  append_all(out, {static_cast<double>(status.missed), status.tick_p50_us, status.tick_p99_us,
                   status.tick_max_us, status.late_p99_us, 1e-3 * tick.state_age_ns});
  // 14: certificate.
  append_all(out, {contacts.min_distance_m, certificate.error_bound_m, certificate.force_bound_N,
                   static_cast<double>(certificate.contact), bits_of(certificate), tick.energy_J});
  // 20: wrench.
  append_all(out, {rendered_N[0], rendered_N[1], rendered_N[2]});
  for (const float value : sent_N) append(out, static_cast<double>(value));
  for (const float value : sent_Nm) append(out, static_cast<double>(value));
  // 29: where the tool is, and the hand.
  append_pose(out, contacts.tool, origin_m);
  append_pose(out, pose_of_record(tick), origin_m);
  for (const Sample& s : samples) {
    const auto before_s = static_cast<float>(s.t_s - now_s);
    for (const float value : {before_s, s.rendered_N, s.sent_N, s.sent_Nm, s.energy_J, s.tick_us,
                              s.late_us, static_cast<float>(s.marks)}) {
      append(out, value);
    }
  }
  for (std::uint32_t i = 0; i < contacts.shown; ++i) {
    const realtime::LiveContact& c = contacts.contacts[i];
    for (const float value : c.centre_m) append(out, value);
    for (const float value : c.normal) append(out, value);
    append(out, c.distance_m);
    append(out, c.force_N);
  }
}

}  // namespace palpate::live

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/feed.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::live {
namespace {

constexpr std::size_t kBatch = 1024;  ///< records taken at once

template <class T>
float length(const std::array<T, 3>& v) {
  return static_cast<float>(std::hypot(v[0], v[1], v[2]));
}

}  // namespace

Feed::Feed(realtime::LiveTap& tap, double rate_Hz, const Pose& start,
           std::function<void(const hal::mock::Lead&)> lead)
    : tap_(tap),
      rate_Hz_(rate_Hz),
      origin_m_(start.position_m),
      lead_(std::move(lead)),
      batch_(kBatch),
      strip_(static_cast<std::size_t>(kStrip_s * kSamples_Hz)),
      ticks_a_sample_(std::max<std::uint64_t>(
          1, static_cast<std::uint64_t>(std::ceil(rate_Hz / kSamples_Hz)))) {
  const Vec3d& p = start.position_m;
  const Quat& q = start.orientation;
  status_.tick.position_m = {p.x, p.y, p.z};
  status_.tick.orientation = {q.w, q.x, q.y, q.z};
  contacts_.tool = start;
  contacts_.min_distance_m = std::nan("");
}

void Feed::update() {
  for (std::size_t count = kBatch; count == kBatch;) {
    count = tap_.records.pop(batch_);
    for (std::size_t i = 0; i < count; ++i) take(batch_[i]);
  }
  static_cast<void>(tap_.ticks.read(contacts_));
  status_.ended = ended_;
  status_.tick_p50_us = 1e-3 * static_cast<double>(tick_ns_.percentile_ns(0.5));
  status_.tick_p99_us = 1e-3 * static_cast<double>(tick_ns_.percentile_ns(0.99));
  status_.tick_max_us = 1e-3 * static_cast<double>(tick_ns_.max_ns());
  status_.late_p99_us = 1e-3 * static_cast<double>(late_ns_.percentile_ns(0.99));
}

/// Due times lie on a grid: a period without a tick was missed.
std::uint64_t Feed::missed_before(const realtime::TraceRecord& record) const {
  const double period = std::round(1e-9 * static_cast<double>(record.time_ns) * rate_Hz_);
  const double missed = period - static_cast<double>(record.tick);
  return missed > 0 ? static_cast<std::uint64_t>(missed) : 0;
}

void Feed::take(const realtime::TraceRecord& record) {
  tick_ns_.add(record.tick_ns);
  late_ns_.add(record.latency_ns);
  const std::uint64_t missed = missed_before(record);
  const bool new_fault = (record.faults & ~faults_) != 0;
  faults_ = record.faults;

  Sample& s = sample_;
  s.t_s = 1e-9 * static_cast<double>(record.time_ns);
  s.rendered_N = std::max(s.rendered_N, length(record.rendered_force_N));
  s.sent_N = std::max(s.sent_N, length(record.sent_force_N));
  s.sent_Nm = std::max(s.sent_Nm, length(record.sent_torque_Nm));
  s.energy_J = static_cast<float>(record.energy_J);
  s.tick_us = std::max(s.tick_us, 1e-3f * static_cast<float>(record.tick_ns));
  s.late_us = std::max(s.late_us, 1e-3f * static_cast<float>(record.latency_ns));
  s.marks |= (missed > status_.missed ? kMissed : 0u) | (new_fault ? kFault : 0u) |
             (record.truncated != 0 ? kCutByBudget : 0u);
  if (++ticks_in_sample_ == ticks_a_sample_) {
    strip_[samples_++ % strip_.size()] = std::exchange(sample_, {});
    ticks_in_sample_ = 0;
  }
  status_.missed = missed;
  status_.tick = record;
}

void Feed::frame(std::uint64_t& seen, std::vector<std::byte>& out) const {
  const std::uint64_t size = strip_.size();
  const std::uint64_t oldest = samples_ > size ? samples_ - size : 0;
  std::vector<Sample> samples;
  for (std::uint64_t i = std::max(seen, oldest); i < samples_; ++i) {
    samples.push_back(strip_[i % size]);
  }
  seen = samples_;
  encode_frame(status_, samples, contacts_, origin_m_, out);
}

bool Feed::message(std::span<const std::byte> bytes) {
  std::optional<hal::mock::Lead> said = parse_lead(bytes);
  if (!said || !lead_) return false;
  said->to.position_m += origin_m_;
  lead_(*said);
  return true;
}

void Feed::left() {
  if (lead_) lead_({false, {}});
}

}  // namespace palpate::live

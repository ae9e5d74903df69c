// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/loop.hpp"

#include <algorithm>
#include <cmath>

#include "hal/rotation.hpp"
#include "tools/realtime/budget_clock.hpp"

namespace palpate::realtime {
namespace {

std::uint64_t elapsed(std::uint64_t from_ns, std::uint64_t to_ns) {
  return to_ns > from_ns ? to_ns - from_ns : 0;
}

std::uint32_t saturated(std::uint64_t value) {
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>(value, std::numeric_limits<std::uint32_t>::max()));
}

std::array<double, 3> array_of(const Vec3d& v) { return {v.x, v.y, v.z}; }
std::array<float, 3> float_array_of(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::uint8_t truncation_bits(const Certificate& c) {
  const int bits = (c.truncated_by_time ? kByTime : 0) | (c.truncated_by_units ? kByUnits : 0) |
                   (c.truncated_by_memory ? kByMemory : 0);
  return static_cast<std::uint8_t>(bits);
}

/// Notes for each bit that was not there before the tick in which it came.
template <class Bits, std::size_t kCount>
void note_new(Bits now, Bits& seen, std::array<std::uint64_t, kCount>& ticks, std::uint64_t tick) {
  for (std::size_t i = 0; i < kCount; ++i) {
    if ((now >> i & ~(seen >> i) & 1u) != 0) ticks[i] = tick;
  }
  seen = static_cast<Bits>(seen | now);
}

}  // namespace

/// One tick in the making.
struct Loop::Tick {
  std::uint64_t due_ns = 0;
  std::uint64_t begin_ns = 0;
  std::uint64_t end_ns = 0;
  std::uint64_t state_age_ns = 0;
  bool queried = false;
  Status status = Status::ok;
  TickResult result;
};

Loop::Loop(const LoopSettings& settings, hal::Device& device, ContactQuery& query,
           hal::Clock& clock, hal::Ring<TraceRecord>* telemetry, hal::Ring<TraceRecord>* live)
    : settings_(settings),
      device_(device),
      query_(query),
      clock_(clock),
      telemetry_(telemetry),
      live_(live),
      safety_(settings.safety, 1.0 / settings.rate_Hz),
      passivity_(settings.passivity_limits),
      period_ns_(nanoseconds(1.0 / settings.rate_Hz)) {}

void Loop::run(const std::atomic<bool>& stop) noexcept {
  start_ns_ = clock_.now_ns() + period_ns_;
  // A short run still has ticks to count.
  const std::uint64_t warm_up =
      std::min<std::uint64_t>(settings_.warm_up_ticks, settings_.periods / 10);
  ThreadCounters before = thread_counters();
  std::uint64_t period = 0;
  while (period - report_.homing < settings_.periods && !stop.load(std::memory_order_relaxed)) {
    if (report_.ticks == warm_up) before = thread_counters();
    const std::uint64_t late = run_tick(start_ns_ + period * period_ns_);
    report_.missed += late;
    period += 1 + late;
    if (safety_.state() == LoopState::homing) report_.homing += 1 + late;
    periods_passed_.store(period - report_.homing, std::memory_order_relaxed);
  }
  report_.counted = thread_counters() - before;
  report_.state = safety_.state();
  send({});
}

/// Returns how many periods have passed without a command of their own: 0 where the tick met its
/// deadline.
std::uint64_t Loop::run_tick(std::uint64_t due_ns) noexcept {
  clock_.sleep_until(due_ns);
  Tick tick;
  tick.due_ns = due_ns;
  tick.begin_ns = clock_.now_ns();
  read_device(tick);
  query_contacts(tick);
  Wrench rendered = tick.result.wrench;
  if (settings_.passivity_control) rendered = passivity_.control(rendered, 1 / settings_.rate_Hz);
  send(safety_.command(tick.status, rendered, passivity_.velocity()));
  tick.end_ns = clock_.now_ns();

  const std::uint64_t late = elapsed(due_ns, tick.end_ns) / period_ns_;
  safety_.tick_ended(late);
  note_faults();
  account(tick);
  if (telemetry_ != nullptr || live_ != nullptr) record(tick);
  ++report_.ticks;
  return late;
}

void Loop::read_device(Tick& tick) noexcept {
  const bool had_pose = reading_.sequence != 0 && !reading_.homing;
  const std::uint64_t before_ns = reading_.time_ns;
  const bool fresh = device_.receive(reading_);
  if (settings_.fixed_orientation) reading_.pose.orientation = *settings_.fixed_orientation;
  if (fresh && had_pose && !reading_.homing) observe_energy(elapsed(before_ns, reading_.time_ns));
  if (fresh) pose_before_ = reading_.pose;
  tick.state_age_ns = elapsed(reading_.time_ns, tick.begin_ns);
  const hal::DeviceState* newest = reading_.sequence != 0 ? &reading_ : nullptr;
  tick.queried = safety_.accept(newest, 1e-9 * static_cast<double>(tick.state_age_ns));
}

void Loop::query_contacts(Tick& tick) noexcept {
  if (!tick.queried) return;
  const double share_s = settings_.period_share / settings_.rate_Hz;
  const Budget budget = budget_between(clock_, tick.begin_ns, tick.due_ns + nanoseconds(share_s),
                                       settings_.query_time);
  tick.status = query_.tick(reading_.pose, budget, tick.result);
}

void Loop::send(const Wrench& wrench) noexcept {
  ++command_.sequence;
  command_.time_ns = clock_.now_ns();
  command_.expires_ns = command_.time_ns + nanoseconds(settings_.command_life_s);
  command_.wrench = wrench;
  command_.answers = reading_.sequence;
  command_.state_time_ns = reading_.time_ns;
  device_.send(command_);
}

void Loop::observe_energy(std::uint64_t elapsed_ns) noexcept {
  const Vec3d moved_m = reading_.pose.position_m - pose_before_.position_m;
  const Vec3d turned_rad =
      hal::rotation_between(pose_before_.orientation, reading_.pose.orientation);
  passivity_.observe(command_.wrench, moved_m, turned_rad, 1e-9 * static_cast<double>(elapsed_ns));
  report_.energy_J = passivity_.work();
  report_.energy_J_min = passivity_.least_work();
}

void Loop::note_faults() noexcept {
  const std::uint64_t tick = report_.ticks;
  note_new(safety_.faults().bits, report_.faults.bits, report_.fault_ticks, tick);
  note_new(reading_.faults, report_.device_faults, report_.device_fault_ticks, tick);
}

void Loop::account(const Tick& tick) noexcept {
  LoopReport& r = report_;
  const std::uint64_t deadline_ns = tick.due_ns + period_ns_;
  r.overrun_ns_max = std::max(r.overrun_ns_max, elapsed(deadline_ns, tick.end_ns));
  r.latency.add(elapsed(tick.due_ns, tick.begin_ns));
  r.tick.add(elapsed(tick.begin_ns, tick.end_ns));
  if (tick.queried) {
    r.state_age.add(tick.state_age_ns);
    ++r.queried;
    if (tick.result.certificate.truncated()) ++r.truncated;
    if (!tick.result.contacts.empty()) ++r.touching;
    if (tick.result.certificate.contact == ContactStatus::undecided) ++r.undecided;
    if (tick.result.certificate.on_reserve) ++r.on_reserve;
    r.contacts += tick.result.contacts.size();
  }
  const double force_N = norm(command_.wrench.force_N);
  r.force_N_sum += force_N;
  r.force_N_max = std::max(r.force_N_max, force_N);
  r.torque_Nm_max = std::max(r.torque_Nm_max, norm(command_.wrench.torque_Nm));
}

void Loop::record(const Tick& tick) noexcept {
  const TickResult& result = tick.result;
  const Quat& q = reading_.pose.orientation;
  TraceRecord out;
  out.tick = report_.ticks;
  out.time_ns = tick.due_ns - start_ns_;
  out.position_m = array_of(reading_.pose.position_m);
  out.orientation = {q.w, q.x, q.y, q.z};
  out.rendered_force_N = array_of(result.wrench.force_N);
  out.rendered_torque_Nm = array_of(result.wrench.torque_Nm);
  out.sent_force_N = float_array_of(command_.wrench.force_N);
  out.sent_torque_Nm = float_array_of(command_.wrench.torque_Nm);
  out.min_distance_m = result.min_distance_m;
  out.error_bound_m = result.certificate.error_bound_m;
  out.s_worst = result.certificate.s_worst;
  out.force_bound_N = result.certificate.force_bound_N;
  out.energy_J = report_.energy_J;
  out.latency_ns = saturated(elapsed(tick.due_ns, tick.begin_ns));
  out.tick_ns = saturated(elapsed(tick.begin_ns, tick.end_ns));
  out.state_age_ns = saturated(tick.state_age_ns);
  out.contacts = saturated(result.contacts.size());
  out.clusters = result.clusters;
  out.queries = saturated(result.queries);
  out.front_nodes = saturated(result.front_nodes);
  out.state = static_cast<std::uint8_t>(safety_.state());
  out.truncated = truncation_bits(result.certificate);
  out.faults = safety_.faults().bits;
  if (telemetry_ != nullptr) telemetry_->push(out);
  if (live_ != nullptr) live_->push(out);
}

}  // namespace palpate::realtime

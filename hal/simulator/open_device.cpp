// SPDX-License-Identifier: Apache-2.0
#include "hal/simulator/open_device.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "rt_core/image/view.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::hal::simulator {
namespace {

using namespace protocol;

constexpr double kMicro = 1e-6;
constexpr std::uint16_t kUpdateInterface = 1;
constexpr std::uint64_t kNsPerMs = 1'000'000;

std::int32_t nanometres(double m) { return static_cast<std::int32_t>(std::lround(1e9 * m)); }
std::int32_t quaternion_unit(double c) {
  return static_cast<std::int32_t>(std::lround(kUnitQuaternion * c));
}
Vec3d from_micro(const std::array<std::int32_t, 3>& v) {
  return {kMicro * v[0], kMicro * v[1], kMicro * v[2]};
}

/// Of an engine for two bodies of an image, with the default limits.
std::size_t engine_bytes(const ImageView& image) noexcept {
  const std::array bodies{image, image};
  const std::array pairs{BodyPair{.a = 0, .b = 1}};
  return required_bytes({.bodies = bodies, .pairs = pairs, .tool = 0}, Limits{});
}

IoResult give(const Packet& packet, std::span<std::byte> out) {
  const std::size_t length = std::min(out.size(), packet.size());
  std::copy_n(packet.begin(), length, out.begin());
  return {IoStatus::ok, length};
}

}  // namespace

protocol::Capabilities OpenDeviceOptions::default_capabilities() noexcept {
  protocol::Capabilities c;
  c.rate_Hz = 4000;
  c.max_force_uN = 20'000'000;
  c.max_torque_uNm = 1'000'000;
  c.max_life_us = 20'000;
  c.max_state_age_us = 50'000;
  return c;
}

OpenDevice::OpenDevice(OpenDeviceOptions options)
    : options_(std::move(options)),
      descriptors_(open_device_descriptors(options_.serial, options_.flash != nullptr)),
      hand_(options_.hand, 1.0 / options_.capabilities.rate_Hz),
      end_(options_.capabilities),
      period_ns_(1'000'000'000 / options_.capabilities.rate_Hz) {
  options_.capabilities.slots = options_.flash == nullptr ? 0 : flash::kSlots;
  options_.capabilities.image_capacity_bytes =
      options_.flash == nullptr ? 0 : options_.layout.capacity();
  restart();
}

void OpenDevice::advance_to(std::uint64_t now_ns) {
  if (next_ns_ == 0) start_ns_ = next_ns_ = now_ns;
  for (; next_ns_ <= now_ns; next_ns_ += period_ns_) {
    if (back_ns_ != 0 && next_ns_ >= back_ns_) restart();
    period(next_ns_);
  }
  now_ns_ = now_ns;
  work_on_flash();
}

void OpenDevice::work_on_flash() {
  while (dfu_ && dfu_->has_work() && flash_ns_ <= now_ns_) {
    dfu_->work();
    flash_ns_ += dfu_->step_ms() * kNsPerMs;
  }
}

void OpenDevice::period(std::uint64_t now_ns) {
  const Command& command = end_.output(now_ns);
  rendered_ = {from_micro(command.force_uN), from_micro(command.torque_uNm)};
  ++periods_;
  if (norm(rendered_.force_N) + norm(rendered_.torque_Nm) > 0) ++periods_with_force_;
  hand_.advance(rendered_);

  const double t_s = 1e-9 * static_cast<double>(now_ns - start_ns_);
  if (options_.sensor_faults.hit(mock::FaultKind::stuck, t_s) == nullptr) seen_ = hand_.pose();
  const double clock_s = t_s + options_.sensor_faults.clock_error_s(t_s);
  const Vec3d& p = seen_.position_m;
  const Quat& q = seen_.orientation;
  State state;
  state.device_time_ns = 1 + static_cast<std::uint64_t>(std::llround(1e9 * clock_s));
  state.position_nm = {nanometres(p.x), nanometres(p.y), nanometres(p.z)};
  state.orientation = {quaternion_unit(q.w), quaternion_unit(q.x), quaternion_unit(q.y),
                       quaternion_unit(q.z)};
  end_.stamp(state);
  // One that was not fetched is replaced: the host gets the newest.
  if (!silent_ && back_ns_ == 0) ready_ = encode(state);
}

flash::SlotRules OpenDevice::rules() const noexcept {
  flash::SlotRules rules;
  rules.key = options_.key;
  rules.engine_memory_bytes = options_.capabilities.engine_memory_bytes;
  if (rules.engine_memory_bytes > 0) rules.engine_bytes = engine_bytes;
  return rules;
}

ImageIdentity OpenDevice::identity() const {
  ImageIdentity identity;
  if (!slots_ || slots_->active() == flash::kNone) return identity;
  const flash::SlotState state = slots_->state(slots_->active());
  ImageView view;
  if (validate(state.image, view) != Status::ok) return identity;
  identity.active_slot = slots_->active();
  identity.confirmed = state.confirmed;
  identity.format_major = view.header->format_major;
  identity.image_bytes = static_cast<std::uint32_t>(state.image.size());
  identity.sequence = state.sequence;
  std::copy_n(view.header->content_sha256, identity.content_sha256.size(),
              identity.content_sha256.begin());
  return identity;
}

IoResult OpenDevice::control_in(const ControlRequest& request, std::span<std::byte> out) {
  if (request.type == flash::kDfuIn) return update(request, {}, out);
  if (request.type == kVendorIn) return vendor_in(request, out);
  if (is_standard(request)) return standard_in(descriptors_, request, out);
  return {IoStatus::stalled};
}

IoResult OpenDevice::vendor_in(const ControlRequest& request, std::span<std::byte> out) {
  if (request.request != static_cast<std::uint8_t>(Request::read)) return {IoStatus::stalled};
  switch (PacketType{static_cast<std::uint8_t>(request.value >> 8)}) {
    case PacketType::capabilities:
      return give(encode(options_.capabilities), out);
    case PacketType::image_identity:
      return give(encode(identity()), out);
    default:
      return {IoStatus::stalled};
  }
}

IoResult OpenDevice::control_out(const ControlRequest& request, std::span<const std::byte> data) {
  if (request.type == flash::kDfuOut) return update(request, data, {});
  if (request.type == kVendorOut) return vendor_out(request);
  constexpr ControlRequest kChooseSlot{0x01, 0x0b, 0, kUpdateInterface};
  if (request.type == kChooseSlot.type && request.request == kChooseSlot.request &&
      request.index == kChooseSlot.index && dfu_ && request.value < flash::kSlots) {
    dfu_->select(static_cast<std::uint8_t>(request.value));
    return {};
  }
  return is_standard(request) ? standard_out(request) : IoResult{IoStatus::stalled};
}

IoResult OpenDevice::vendor_out(const ControlRequest& request) {
  const bool is_session = request.request == static_cast<std::uint8_t>(Request::session);
  const bool is_restart = request.request == static_cast<std::uint8_t>(Request::restart);
  if (is_restart && !in_session_) {
    leave_bus();
  } else if (is_session && request.value == 1) {
    in_session_ = true;
    end_.begin_session();
  } else if (is_session && request.value == 0) {
    in_session_ = false;
    end_.end_session();
  } else {
    return {IoStatus::stalled};
  }
  return {};
}

IoResult OpenDevice::update(const ControlRequest& request, std::span<const std::byte> data,
                            std::span<std::byte> out) {
  if (!dfu_) return {IoStatus::stalled};
  const bool had_work = dfu_->has_work();
  const flash::DfuAnswer answer =
      dfu_->handle({flash::DfuRequest{request.request}, request.value}, data, out.size());
  if (!had_work) flash_ns_ = now_ns_ + dfu_->step_ms() * kNsPerMs;
  if (dfu_->busy()) end_.end_session();
  if (answer.stall) return {IoStatus::stalled};
  const std::size_t length = std::min(answer.bytes.size(), out.size());
  std::copy_n(answer.bytes.begin(), length, out.begin());
  return {IoStatus::ok, out.empty() ? data.size() : length};
}

void OpenDevice::bus_reset() {
  in_session_ = false;
  end_.end_session();
  if (dfu_) dfu_->bus_reset();
}

/// Its restart begins; this request is still answered.
void OpenDevice::leave_bus() {
  if (options_.restart_ns == 0) return restart();
  bus_reset();
  ready_.reset();
  back_ns_ = now_ns_ + options_.restart_ns;
  ++times_left_;
}

void OpenDevice::restart() {
  bus_reset();
  back_ns_ = 0;
  if (options_.flash == nullptr) return;
  slots_.emplace(*options_.flash, options_.layout, rules());
  dfu_.emplace(*slots_, options_.flash_times);
  const bool holds_image = slots_->start() != flash::kNone && slots_->confirm();
  end_.set_health(holds_image ? kHealthy : kNoImage);
}

void OpenDevice::out(std::span<const std::byte> bytes) {
  if (!end_.receive(bytes, now_ns_)) return;
  const Command& command = end_.output(now_ns_);
  const auto is_something = [](std::int32_t value) { return value != 0; };
  const auto any = [&](const auto& v) { return std::any_of(v.begin(), v.end(), is_something); };
  if (any(command.force_uN) || any(command.torque_uNm)) forced_ns_ = now_ns_;
}

std::size_t OpenDevice::in(std::span<std::byte> buffer) {
  if (!ready_) return 0;
  return give(*std::exchange(ready_, std::nullopt), buffer).bytes;
}

}  // namespace palpate::hal::simulator

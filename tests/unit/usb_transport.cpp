// SPDX-License-Identifier: Apache-2.0
// The real libusb under the device layer, over an emulated usbfs.
#include "hal/usb/libusb_transport.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <functional>
#include <thread>

#include "../support/emulated_usbfs.hpp"
#include "../support/tiny_image.hpp"
#include "hal/falcon/driver.hpp"
#include "hal/flash/update.hpp"
#include "hal/protocol/host_driver.hpp"
#include "hal/simulator/falcon_device.hpp"
#include "hal/simulator/flash_model.hpp"
#include "hal/simulator/open_device.hpp"
#include "hal/transport/streamed_device.hpp"

namespace palpate::hal::usb {
namespace {

using simulator::OpenDevice;
using simulator::OpenDeviceOptions;
using test::EmulatedUsbfs;

constexpr std::uint64_t kMs = 1'000'000;
constexpr std::uint8_t kInEndpoint = 0x81;
constexpr std::uint8_t kOutEndpoint = 0x01;

/// An open device over the emulation. `kind` chooses the interface.
std::unique_ptr<LibusbTransport> transport_of(EmulatedUsbfs& usbfs, Kind kind) {
  libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
  Context context = make_context();
  libusb_device_handle* handle = nullptr;
  if (!context || libusb_wrap_sys_device(context.get(), usbfs.open(), &handle) != 0) {
    ADD_FAILURE() << "libusb does not take the descriptor";
    return nullptr;
  }
  Handle owned(handle);
  const auto interface = find_interface(kind, libusb_get_device(handle));
  if (!interface || libusb_claim_interface(handle, interface->number) != 0) {
    ADD_FAILURE() << "no such interface";
    return nullptr;
  }
  return std::make_unique<LibusbTransport>(std::move(context), std::move(owned), *interface);
}

struct UsbRig {
  explicit UsbRig(OpenDeviceOptions options = {}) : model(std::move(options)), usbfs(model) {
    auto transport = transport_of(usbfs, Kind::open_protocol);
    device = std::make_unique<StreamedDevice>(
        std::move(transport), std::make_unique<protocol::HostDriver>(), clock, StreamOptions{});
  }

  [[nodiscard]] std::optional<DeviceProblem> begin() {
    if (auto problem = device->open()) return problem;
    return device->start();
  }

  /// A loop's ticks at 1 kHz for a while, or until it is enough.
  void run(
      std::uint64_t for_ns, const std::function<bool()>& enough = [] { return false; }) {
    const std::uint64_t end_ns = clock.now_ns() + for_ns;
    for (std::uint64_t next_ns = clock.now_ns(); next_ns < end_ns && !enough(); next_ns += kMs) {
      clock.sleep_until(next_ns);
      if (device->receive(reading)) ++readings;
      ++command.sequence;
      command.time_ns = clock.now_ns();
      command.expires_ns = clock.now_ns() + 500 * kMs;  // a shared machine may stall for long
      command.wrench.force_N = {3, 0, 0};
      command.answers = reading.sequence;
      command.state_time_ns = reading.time_ns;
      device->send(command);
    }
  }
  bool has_faults(std::uint32_t faults) const { return (device->faults() & faults) != 0; }
  double rendered_N() {
    return usbfs.look([this] { return norm(model.rendered().force_N); });
  }
  /// Waits for something, a second at most.
  bool comes_true(const std::function<bool()>& condition) {
    const std::uint64_t end_ns = clock.now_ns() + 1000 * kMs;
    while (!condition() && clock.now_ns() < end_ns) clock.sleep_until(clock.now_ns() + kMs);
    return condition();
  }
  /// The device lives on a thread of its own: its next period shows what has become of the force.
  bool force_ends() {
    return comes_true([this] { return rendered_N() == 0.0; });
  }

  MonotonicClock clock;
  OpenDevice model;
  EmulatedUsbfs usbfs;
  std::unique_ptr<StreamedDevice> device;
  DeviceState reading;
  DeviceCommand command;
  std::uint64_t readings = 0;
};

/// The longest life that the protocol knows: what a shared machine may stand still for.
OpenDeviceOptions patient() {
  OpenDeviceOptions options;
  options.capabilities.max_life_us = protocol::kMaxCommandLife_us;
  options.capabilities.max_state_age_us = 1'000'000;
  return options;
}

TEST(Libusb, interfaces_are_found_by_what_they_are) {
  simulator::FlashModel memory({});
  OpenDeviceOptions options;
  options.flash = &memory;
  OpenDevice model(options);
  EmulatedUsbfs usbfs(model);
  const Context context = make_context();
  libusb_device_handle* handle = nullptr;
  ASSERT_EQ(libusb_wrap_sys_device(context.get(), usbfs.open(), &handle), 0);
  const Handle owned(handle);
  libusb_device* device = libusb_get_device(handle);
  const auto exchange = find_interface(Kind::open_protocol, device);
  ASSERT_TRUE(exchange);
  EXPECT_EQ(exchange->number, 0);
  EXPECT_EQ(exchange->in_address, kInEndpoint);
  EXPECT_EQ(exchange->out_address, kOutEndpoint);
  EXPECT_EQ(exchange->in_type, LIBUSB_TRANSFER_TYPE_INTERRUPT);
  EXPECT_EQ(exchange->in_packet_bytes, 64);
  const auto update = find_interface(Kind::update, device);
  ASSERT_TRUE(update);
  EXPECT_EQ(update->number, 1);
  EXPECT_FALSE(find_interface(Kind::falcon, device));
}

TEST(Libusb, interface_is_for_one_program_at_a_time) {
  OpenDevice model({});
  EmulatedUsbfs usbfs(model);
  auto first = transport_of(usbfs, Kind::open_protocol);
  const Context context = make_context();
  libusb_device_handle* handle = nullptr;
  ASSERT_EQ(libusb_wrap_sys_device(context.get(), usbfs.open(), &handle), 0);
  const Handle second(handle);
  EXPECT_EQ(libusb_claim_interface(handle, 0), LIBUSB_ERROR_BUSY);
  EXPECT_EQ(libusb_claim_interface(handle, 7), LIBUSB_ERROR_NOT_FOUND);
  first.reset();
  EXPECT_EQ(libusb_claim_interface(handle, 0), 0);
}

TEST(Libusb, exchange_runs_with_every_in_transfer_pending) {
  UsbRig rig(patient());
  ASSERT_FALSE(rig.begin());
  rig.run(500 * kMs);
  EXPECT_GT(rig.readings, 50u);
  EXPECT_EQ(rig.device->faults(), kNoDeviceFault);
  EXPECT_GT(rig.rendered_N(), 2.9);
  // With nothing to deliver, all of them are back with the host controller.
  rig.usbfs.look([&] { rig.model.set_silent(true); });
  EXPECT_TRUE(
      rig.comes_true([&] { return rig.usbfs.under_way() == LibusbTransport::kInTransfers; }));
  rig.device->stop();
  EXPECT_EQ(rig.usbfs.under_way(), 0u);
  EXPECT_TRUE(rig.force_ends());
}

TEST(Libusb, stalled_endpoints_are_cleared_and_go_on) {
  UsbRig rig(patient());
  ASSERT_FALSE(rig.begin());
  rig.run(50 * kMs);
  rig.usbfs.fail_next(kInEndpoint, -EPIPE);
  rig.usbfs.fail_next(kOutEndpoint, -EPIPE);
  rig.run(1000 * kMs, [&] { return rig.usbfs.halts_cleared() == 2; });
  EXPECT_EQ(rig.usbfs.halts_cleared(), 2);
  const std::uint64_t before = rig.readings;
  rig.run(100 * kMs);
  EXPECT_GT(rig.readings, before);
  EXPECT_EQ(rig.device->faults(), kNoDeviceFault);
}

TEST(Libusb, single_errors_are_survived_and_a_row_of_them_is_a_loss) {
  UsbRig rig(patient());
  ASSERT_FALSE(rig.begin());
  rig.usbfs.fail_next(kInEndpoint, -EPROTO, 3);
  rig.run(100 * kMs);
  EXPECT_EQ(rig.device->faults(), kNoDeviceFault);
  rig.usbfs.fail_next(kInEndpoint, -EPROTO, 1000);
  rig.run(1000 * kMs, [&] { return rig.has_faults(kDeviceLost); });
  EXPECT_TRUE(rig.has_faults(kDeviceLost));
}

TEST(Libusb, swallowed_out_transfers_do_not_block_the_exchange) {
  UsbRig rig(patient());
  ASSERT_FALSE(rig.begin());
  rig.run(100 * kMs);
  rig.usbfs.hold_out(true);
  rig.run(2000 * kMs, [&] { return rig.has_faults(kDeviceSilenced); });
  EXPECT_TRUE(rig.has_faults(kDeviceSilenced));
  EXPECT_TRUE(rig.force_ends());
  EXPECT_GT(rig.device->crowded_out(), 0u);
  rig.device->stop();
  EXPECT_EQ(rig.usbfs.under_way(), 0u);
}

TEST(Libusb, unplugging_while_streaming_is_a_loss_and_stop_comes_back) {
  for (const std::uint64_t after_ms : {0u, 1u, 7u, 40u}) {
    UsbRig rig(patient());
    ASSERT_FALSE(rig.begin());
    rig.run(after_ms * kMs);
    rig.usbfs.unplug();
    rig.run(2000 * kMs, [&] { return rig.has_faults(kDeviceLost); });
    EXPECT_TRUE(rig.has_faults(kDeviceLost));
    rig.device->stop();
    EXPECT_EQ(rig.usbfs.under_way(), 0u);
    EXPECT_TRUE(rig.force_ends());
  }
}

TEST(Libusb, unplugging_with_out_transfers_under_way_is_a_loss) {
  UsbRig rig(patient());
  ASSERT_FALSE(rig.begin());
  rig.usbfs.hold_out(true);
  rig.run(50 * kMs);
  rig.usbfs.unplug();
  rig.run(2000 * kMs, [&] { return rig.has_faults(kDeviceLost); });
  EXPECT_TRUE(rig.has_faults(kDeviceLost));
  rig.device->stop();
}

// The plug is pulled at each transfer of a device's life: opening, starting, exchange, stopping.
TEST(Libusb, unplugging_before_any_transfer_is_a_problem_or_a_loss_and_never_a_hang) {
  int lost_while_streaming = 0;
  for (int submissions = 0; submissions < 40; ++submissions) {
    UsbRig rig(patient());
    rig.usbfs.unplug_after(submissions);
    if (const auto problem = rig.begin()) {
      EXPECT_FALSE(problem->phase.empty()) << submissions;
      EXPECT_FALSE(problem->fix.empty()) << submissions;
    } else {
      rig.run(3000 * kMs, [&] { return rig.has_faults(kDeviceLost); });
      EXPECT_TRUE(rig.has_faults(kDeviceLost)) << submissions;
      ++lost_while_streaming;
    }
    rig.device->stop();
    EXPECT_EQ(rig.usbfs.under_way(), 0u) << submissions;
    EXPECT_TRUE(rig.force_ends()) << submissions;
  }
  EXPECT_GT(lost_while_streaming, 20);
}

TEST(Libusb, unplugged_device_fails_at_its_phase) {
  UsbRig before_open;
  before_open.usbfs.unplug();
  const auto problem = before_open.device->open();
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->phase, "descriptors");
  EXPECT_EQ(problem->cause, "the device is gone");

  UsbRig before_start;
  ASSERT_FALSE(before_start.device->open());
  before_start.usbfs.unplug();
  EXPECT_TRUE(before_start.device->start());
}

TEST(Libusb, control_requests_that_are_refused_or_ignored_are_told_apart) {
  OpenDevice model({});
  EmulatedUsbfs usbfs(model);
  const auto transport = transport_of(usbfs, Kind::open_protocol);
  std::array<std::byte, 64> reply{};
  EXPECT_EQ(transport->control_in({protocol::kVendorIn, 0x7f, 0, 0}, reply, 500).status,
            IoStatus::stalled);
  usbfs.hold_control(true);
  EXPECT_EQ(transport->control_in({protocol::kVendorIn, 1, 0x8100, 0}, reply, 50).status,
            IoStatus::timed_out);
  usbfs.hold_control(false);
  const IoResult result = transport->control_in({protocol::kVendorIn, 1, 0x8100, 0}, reply, 500);
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.bytes, 64u);
}

TEST(Libusb, transport_can_stream_again_after_it_has_ended) {
  UsbRig rig(patient());
  ASSERT_FALSE(rig.begin());
  rig.run(30 * kMs);
  rig.device->stop();
  ASSERT_FALSE(rig.device->start());
  const std::uint64_t before = rig.readings;
  rig.run(100 * kMs);
  EXPECT_GT(rig.readings, before);
  EXPECT_EQ(rig.device->faults(), kNoDeviceFault);
}

TEST(Libusb, image_is_written_read_back_and_used) {
  const flash::SlotLayout layout{1024, 8};
  simulator::FlashModel memory(layout);
  OpenDeviceOptions options;
  options.flash = &memory;
  options.layout = layout;
  OpenDevice model(options);
  EmulatedUsbfs usbfs(model);
  const auto image =
      palpate::test::seal(palpate::test::parts_of({palpate::test::ball_part(0.5f, 5, 8)}));
  MonotonicClock clock;
  {
    const auto update = transport_of(usbfs, Kind::update);
    const auto problem = flash::write_slot(*update, clock, 1, image, [](const char*, double) {});
    ASSERT_FALSE(problem) << problem->phase << ": " << problem->cause;
  }
  auto exchange = transport_of(usbfs, Kind::open_protocol);
  ASSERT_FALSE(flash::restart(*exchange));
  flash::UpdateTarget target;
  const auto gone = flash::read_target(*exchange, target);
  ASSERT_TRUE(gone);
  EXPECT_EQ(gone->cause, "the device is gone");
  while (!usbfs.look([&] { return model.presence().on_bus; })) std::this_thread::yield();
  exchange = transport_of(usbfs, Kind::open_protocol);
  ASSERT_FALSE(flash::read_target(*exchange, target));
  EXPECT_EQ(target.image.active_slot, 1);
  EXPECT_EQ(target.image.image_bytes, image.size());
}

TEST(Libusb, falcon_gets_its_firmware_and_gives_readings) {
  simulator::FalconDeviceOptions options;
  options.homed_after_s = 0.05;
  simulator::FalconDevice model(options);
  EmulatedUsbfs usbfs(model);
  MonotonicClock clock;
  StreamedDevice device(transport_of(usbfs, Kind::falcon),
                        std::make_unique<falcon::FalconDriver>(std::vector<std::byte>(2000)), clock,
                        {});
  const auto opened = device.open();
  ASSERT_FALSE(opened) << opened->phase << ": " << opened->cause;
  ASSERT_FALSE(device.start());
  std::uint64_t readings = 0;
  DeviceState reading;
  const std::uint64_t end_ns = clock.now_ns() + 300 * kMs;
  while (clock.now_ns() < end_ns) {
    if (device.receive(reading)) ++readings;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  EXPECT_GT(readings, 20u);
  EXPECT_LT(norm(reading.pose.position_m), 1e-3);
  device.stop();
  EXPECT_EQ(usbfs.look([&] { return model.motors(); }), falcon::MotorValues{});
}

}  // namespace
}  // namespace palpate::hal::usb

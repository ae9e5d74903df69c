// SPDX-License-Identifier: Apache-2.0
// Updates of flash that takes its time: erased block by block, while the host is told how long to
// wait and does.
#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "../support/time.hpp"
#include "../support/tiny_image.hpp"
#include "../support/virtual_clock.hpp"
#include "hal/flash/update.hpp"
#include "hal/simulator/flash_model.hpp"
#include "hal/simulator/open_device.hpp"
#include "hal/simulator/port.hpp"

namespace palpate::hal::flash {
namespace {

using hal::test::kMs;
using hal::test::VirtualClock;
using simulator::FlashModel;
using simulator::OpenDevice;
using simulator::OpenDeviceOptions;
using simulator::Port;

/// A NOR flash of 128 units that take 45 ms each to erase.
constexpr SlotLayout kNor{256, 128};
constexpr FlashTimes kNorTimes{45, 3, 1500};

palpate::test::AlignedBytes image() {
  const auto part = palpate::test::ball_part(0.5f, 5, 26);
  return palpate::test::seal(palpate::test::parts_of({part, part, part}));
}

OpenDeviceOptions nor_device(FlashModel& flash, const FlashTimes& times = kNorTimes) {
  OpenDeviceOptions options;
  options.flash = &flash;
  options.layout = kNor;
  options.flash_times = times;
  return options;
}

/// As strict as DFU 1.1 allows: nothing may be asked while the flash is busy, and no request may
/// take longer than its time-out.
class Strict final : public OpenDevice {
 public:
  explicit Strict(OpenDeviceOptions options) : OpenDevice(std::move(options)) {}
  void advance_to(std::uint64_t now_ns) override {
    now_ns_ = now_ns;
    OpenDevice::advance_to(now_ns);
  }
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out) override {
    const bool is_status = request.type == kDfuIn &&
                           request.request == static_cast<std::uint8_t>(DfuRequest::get_status);
    if (!is_status) return OpenDevice::control_in(request, out);
    if (now_ns_ < ready_ns_) return {IoStatus::stalled};
    const IoResult result = OpenDevice::control_in(request, out);
    const std::uint32_t poll_ms = get<std::uint32_t>(out, 0) >> 8;
    longest_poll_ms = std::max(longest_poll_ms, poll_ms);
    ready_ns_ = now_ns_ + poll_ms * kMs;
    return result;
  }
  std::uint32_t longest_poll_ms = 0;

 private:
  std::uint64_t now_ns_ = 0;
  std::uint64_t ready_ns_ = 0;
};

std::optional<DeviceProblem> write(OpenDevice& device, VirtualClock& clock, std::uint8_t slot,
                                   std::span<const std::byte> bytes) {
  Port port(device, clock);
  port.claim(1);
  return write_slot(port, clock, slot, bytes, [](const char*, double) {});
}

TEST(FlashTimes, nor_flash_of_128_units_at_45_ms_is_written_block_by_block) {
  VirtualClock clock;
  FlashModel flash(kNor);
  Strict device(nor_device(flash));
  const auto bytes = image();
  ASSERT_GT(bytes.size(), std::size_t{kNor.capacity()} / 2);
  const std::uint64_t begin_ns = clock.now_ns();
  const auto problem = write(device, clock, 1, bytes);
  ASSERT_FALSE(problem) << problem->phase << ": " << problem->cause;
  const std::uint64_t units = 1 + (bytes.size() + kNor.erase_bytes - 1) / kNor.erase_bytes;
  EXPECT_EQ(flash.erasures(), units);
  EXPECT_GE(clock.now_ns() - begin_ns, units * kNorTimes.erase_ms * kMs);
  // The record and the four units of the first block; or the manifestation.
  EXPECT_EQ(device.longest_poll_ms, kNorTimes.check_ms);
  EXPECT_FALSE(flash.misused());
}

TEST(FlashTimes, host_waits_for_as_long_as_the_device_states) {
  for (const std::uint32_t erase_ms : {1u, 999u, 5760u}) {
    VirtualClock clock;
    FlashModel flash(kNor);
    Strict device(nor_device(flash, {erase_ms, 0, 20'000}));
    const auto problem = write(device, clock, 0, image());
    ASSERT_FALSE(problem) << erase_ms << ", " << problem->phase << ": " << problem->cause;
  }
}

TEST(FlashTimes, device_that_states_hours_is_given_up) {
  VirtualClock clock;
  FlashModel flash(kNor);
  Strict device(nor_device(flash, {3'600'000, 0, 0}));
  const std::uint64_t begin_ns = clock.now_ns();
  const auto problem = write(device, clock, 0, image());
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->phase, "write");
  EXPECT_LT(clock.now_ns() - begin_ns, 1000 * kMs);
}

TEST(FlashTimes, requests_never_touch_the_flash_and_each_step_is_one_erasure_at_most) {
  FlashModel flash(kNor);
  Slots slots(flash, kNor);
  DfuDevice dfu(slots, kNorTimes);
  const auto bytes = image();
  const auto status = [&] {
    const auto reply = dfu.handle({DfuRequest::get_status, 0}, {}, kStatusReplyBytes).bytes;
    EXPECT_EQ(reply[0], std::byte{0});
    return std::pair(DfuState{get<std::uint8_t>(reply, 4)}, get<std::uint32_t>(reply, 0) >> 8);
  };
  std::uint16_t block = 0;
  for (std::size_t at = 0; at <= bytes.size(); at += DfuDevice::kTransferBytes) {
    const std::uint64_t steps = flash.steps();
    const auto part = std::span<const std::byte>(bytes).subspan(
        at, std::min<std::size_t>(DfuDevice::kTransferBytes, bytes.size() - at));
    ASSERT_FALSE(dfu.handle({DfuRequest::download, block++}, part, 0).stall);
    const auto [state, stated_ms] = status();
    EXPECT_EQ(state, DfuState::download_busy);
    EXPECT_EQ(flash.steps(), steps);
    std::uint32_t taken_ms = 0;
    while (dfu.has_work()) {
      const std::uint64_t erasures = flash.erasures();
      taken_ms += dfu.step_ms();
      EXPECT_EQ(status().first, DfuState::download_busy);
      dfu.work();
      EXPECT_LE(flash.erasures(), erasures + 1);
    }
    EXPECT_EQ(taken_ms, stated_ms);
    EXPECT_EQ(status(), std::pair(DfuState::download_idle, 0u));
  }
  ASSERT_FALSE(dfu.handle({DfuRequest::download, block}, {}, 0).stall);
  EXPECT_EQ(status(), std::pair(DfuState::manifest, kNorTimes.check_ms));
  EXPECT_FALSE(dfu.work());
  EXPECT_EQ(status(), std::pair(DfuState::idle, 0u));
  EXPECT_EQ(slots.start(), 0);
}

TEST(FlashTimes, failed_erasure_is_reported_with_the_next_status) {
  FlashModel flash(kNor);
  Slots slots(flash, kNor);
  DfuDevice dfu(slots);
  flash.cut_power_after(6);  // within the second erasure
  const std::vector<std::byte> block(DfuDevice::kTransferBytes);
  ASSERT_FALSE(dfu.handle({DfuRequest::download, 0}, block, 0).stall);
  EXPECT_TRUE(dfu.work());
  EXPECT_FALSE(dfu.work());
  const auto reply = dfu.handle({DfuRequest::get_status, 0}, {}, kStatusReplyBytes).bytes;
  EXPECT_EQ(reply[0], static_cast<std::byte>(DfuStatus::erase));
  EXPECT_EQ(reply[4], static_cast<std::byte>(DfuState::error));
}

}  // namespace
}  // namespace palpate::hal::flash

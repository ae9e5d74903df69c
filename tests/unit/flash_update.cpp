// SPDX-License-Identifier: Apache-2.0
// DFU on both ends, the suffix of its files, and whole updates over a simulated device.
#include "hal/flash/update.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <random>
#include <string>

#include "../support/simulated_rig.hpp"
#include "../support/tiny_image.hpp"
#include "hal/flash/dfu_suffix.hpp"
#include "hal/simulator/flash_model.hpp"

namespace palpate::hal::flash {
namespace {

using hal::test::kMs;
using hal::test::VirtualClock;
using palpate::test::AlignedBytes;
using simulator::FlashModel;
using simulator::OpenDevice;
using simulator::OpenDeviceOptions;
using simulator::Port;

constexpr SlotLayout kTwoSlots{1024, 8};

AlignedBytes image_of(double radius_m, unsigned segments = 8) {
  return palpate::test::seal(
      palpate::test::parts_of({palpate::test::ball_part(0.5f, 5, segments)}, radius_m));
}

OpenDeviceOptions with(FlashModel& flash) {
  OpenDeviceOptions options;
  options.flash = &flash;
  options.layout = kTwoSlots;
  return options;
}

constexpr std::uint8_t kUpdateInterface = 1;

/// Through the device's interface for updates.
std::optional<DeviceProblem> write(Port& port, VirtualClock& clock, std::uint8_t slot,
                                   std::span<const std::byte> bytes) {
  port.claim(kUpdateInterface);
  auto problem = write_slot(port, clock, slot, bytes, [](const char*, double) {});
  port.claim(0);
  return problem;
}

/// A device on a port, updated as `palpate flash` does it.
struct UpdateRig {
  UpdateRig() : flash(kTwoSlots), device(with(flash)) { plug_in(); }

  void plug_in() {
    while (!device.presence().on_bus) {
      clock.sleep_until(clock.now_ns() + kMs);
      device.advance_to(clock.now_ns());
    }
    port = std::make_unique<Port>(device, clock);
  }

  std::optional<DeviceProblem> update(const AlignedBytes& bytes,
                                      std::optional<std::uint8_t> wanted = std::nullopt) {
    UpdateTarget target;
    if (auto bad = read_target(*port, target)) return bad;
    const auto slot = choose_slot(target, bytes.size(), wanted);
    if (const auto* bad = std::get_if<DeviceProblem>(&slot)) return *bad;
    if (auto bad = write(*port, clock, std::get<std::uint8_t>(slot), bytes)) return bad;
    if (auto bad = restart(*port)) return bad;
    EXPECT_TRUE(read_target(*port, target));  // it has left the bus
    plug_in();
    return std::nullopt;
  }

  /// The hash of the image in use; zero where there is none.
  std::array<std::uint8_t, 32> in_use() {
    UpdateTarget target;
    EXPECT_FALSE(read_target(*port, target));
    return target.image.content_sha256;
  }

  VirtualClock clock;
  FlashModel flash;
  OpenDevice device;
  std::unique_ptr<Port> port;
};

std::array<std::uint8_t, 32> hash_of(const AlignedBytes& bytes) {
  std::array<std::uint8_t, 32> hash{};
  std::memcpy(hash.data(), bytes.data() + offsetof(image::Header, content_sha256), hash.size());
  return hash;
}

// Made by another program (dfu-suffix 0.11) for the bytes 0 to 9, with the same identifiers.
TEST(DfuSuffix, golden_bytes_of_another_program_are_met) {
  std::array<std::byte, 10> contents{};
  for (std::size_t i = 0; i < contents.size(); ++i) contents[i] = static_cast<std::byte>(i);
  const std::array<std::uint8_t, 16> golden{0x03, 0x02, 0xcd, 0xab, 0x09, 0x12, 0x00, 0x01,
                                            0x55, 0x46, 0x44, 0x10, 0xe4, 0xad, 0x84, 0x35};
  const auto suffix = make_suffix(contents, {0x1209, 0xabcd, 0x0203});
  for (std::size_t i = 0; i < golden.size(); ++i) {
    EXPECT_EQ(std::to_integer<std::uint8_t>(suffix[i]), golden[i]) << i;
  }
}

TEST(DfuSuffix, round_trip_and_every_change_of_a_byte) {
  const AlignedBytes contents = image_of(1);
  std::vector<std::byte> file(contents.begin(), contents.end());
  const auto suffix = make_suffix(contents, {0x1234, 0x5678, 0x0100});
  file.insert(file.end(), suffix.begin(), suffix.end());
  const auto back = read_suffix(file);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->vendor, 0x1234);
  EXPECT_EQ(back->product, 0x5678);
  EXPECT_EQ(back->device_version, 0x0100);
  for (std::size_t at = 0; at < file.size(); at += at + 40 < file.size() ? 13u : 1u) {
    file[at] ^= std::byte{0x10};
    EXPECT_FALSE(read_suffix(file)) << at;
    file[at] ^= std::byte{0x10};
  }
  EXPECT_FALSE(read_suffix(std::span(file).first(15)));
  EXPECT_FALSE(read_suffix({}));
}

TEST(Update, image_is_written_read_back_and_used_after_the_restart) {
  UpdateRig rig;
  ASSERT_FALSE(rig.update(image_of(1)));
  EXPECT_EQ(rig.in_use(), hash_of(image_of(1)));
  ASSERT_FALSE(rig.update(image_of(2)));
  EXPECT_EQ(rig.in_use(), hash_of(image_of(2)));
  ASSERT_FALSE(rig.update(image_of(3), 0));
  EXPECT_EQ(rig.in_use(), hash_of(image_of(3)));
  EXPECT_FALSE(rig.flash.misused());
}

TEST(Update, device_without_a_restart_keeps_its_image) {
  UpdateRig rig;
  ASSERT_FALSE(rig.update(image_of(1)));
  ASSERT_FALSE(write(*rig.port, rig.clock, 1, image_of(2)));
  EXPECT_EQ(rig.in_use(), hash_of(image_of(1)));
}

TEST(Update, every_size_around_a_block_arrives_whole) {
  for (unsigned segments = 8; segments < 30; ++segments) {
    UpdateRig rig;
    const auto bytes = image_of(1, segments);
    if (bytes.size() > kTwoSlots.capacity()) break;
    ASSERT_FALSE(rig.update(bytes)) << bytes.size();
    EXPECT_EQ(rig.in_use(), hash_of(bytes));
  }
}

TEST(Update, slot_in_use_and_images_too_large_are_refused_before_anything_is_written) {
  UpdateRig rig;
  ASSERT_FALSE(rig.update(image_of(1)));
  const std::uint64_t steps = rig.flash.steps();
  const auto in_use = rig.update(image_of(2), 0);
  ASSERT_TRUE(in_use);
  EXPECT_EQ(in_use->phase, "slot");
  const auto too_large = rig.update(image_of(2, 200));
  ASSERT_TRUE(too_large);
  EXPECT_EQ(too_large->phase, "size");
  EXPECT_EQ(rig.flash.steps(), steps);
}

TEST(Update, device_without_slots_is_named) {
  VirtualClock clock;
  OpenDevice device({});
  Port port(device, clock);
  UpdateTarget target;
  const auto problem = read_target(port, target);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->cause, "the device has no slots for images");
}

TEST(Update, damaged_image_is_refused_by_the_device) {
  UpdateRig rig;
  ASSERT_FALSE(rig.update(image_of(1)));
  AlignedBytes bad = image_of(2);
  bad[600] ^= std::byte{1};
  const auto problem = rig.update(bad);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->phase, "commit");
  EXPECT_EQ(problem->cause, "manifestation: what arrived is no sound image");
  rig.device.restart();
  EXPECT_EQ(rig.in_use(), hash_of(image_of(1)));
}

TEST(Update, unplugging_at_any_block_leaves_the_old_image) {
  UpdateRig rig;
  ASSERT_FALSE(rig.update(image_of(1)));
  for (std::uint64_t cut = 1; cut < 4000; cut += 61) {
    // The plug feeds the device too.
    rig.flash.cut_power_after(cut);
    const auto problem = rig.update(image_of(2));
    rig.flash.restore_power();
    rig.device.restart();
    EXPECT_EQ(rig.in_use(), problem ? hash_of(image_of(1)) : hash_of(image_of(2))) << cut;
    if (!problem) break;
  }
}

/// Gives back one byte changed.
class Liar final : public OpenDevice {
 public:
  using OpenDevice::OpenDevice;
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out) override {
    const IoResult result = OpenDevice::control_in(request, out);
    const bool is_upload =
        request.type == kDfuIn && request.request == static_cast<std::uint8_t>(DfuRequest::upload);
    if (is_upload && request.value == 1 && result.bytes > 0) out[0] ^= std::byte{1};
    return result;
  }
};

TEST(Update, read_back_that_differs_keeps_the_device_from_switching) {
  VirtualClock clock;
  FlashModel flash(kTwoSlots);
  {
    OpenDevice honest(with(flash));
    Port port(honest, clock);
    ASSERT_FALSE(write(port, clock, 0, image_of(1)));
  }
  Liar device(with(flash));
  Port port(device, clock);
  const auto problem = write(port, clock, 1, image_of(2));
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->cause, "the device holds something else than was written");
  device.restart();
  UpdateTarget target;
  ASSERT_FALSE(read_target(port, target));
  EXPECT_EQ(target.image.content_sha256, hash_of(image_of(1)));
}

TEST(Update, update_ends_a_session_and_its_force) {
  UpdateRig rig;
  ASSERT_FALSE(rig.update(image_of(1)));
  const ControlRequest begin{protocol::kVendorOut, 2, 1, 0};
  ASSERT_TRUE(rig.port->control_out(begin, {}, 0).ok());
  const std::vector<std::byte> block(64);
  rig.port->claim(kUpdateInterface);
  ASSERT_TRUE(rig.port->select_alternate(1) == IoStatus::ok);
  ASSERT_TRUE(rig.port->control_out({kDfuOut, 1, 0, 1}, block, 0).ok());
  EXPECT_EQ(rig.device.mode(), protocol::Mode::idle);
  EXPECT_EQ(restart(*rig.port)->cause, "refused by the device");  // the session is still the host's
}

// Any requests in any order: the image in use stays whole, and only a sound one is ever committed.
TEST(DfuDevice, random_requests_never_harm_the_image_in_use) {
  std::mt19937 random(9);
  FlashModel flash(kTwoSlots);
  Slots slots(flash, kTwoSlots);
  const AlignedBytes first = image_of(1);
  ASSERT_EQ(slots.begin(0), UpdateStatus::ok);
  ASSERT_EQ(slots.write(first), UpdateStatus::ok);
  ASSERT_EQ(slots.finish(), UpdateStatus::ok);
  ASSERT_EQ(slots.start(), 0);
  DfuDevice dfu(slots);
  const std::vector<std::byte> data(DfuDevice::kTransferBytes + 8, std::byte{0x5a});
  std::uint16_t block = 0;
  for (int i = 0; i < 100'000; ++i) {
    const auto request = static_cast<DfuRequest>(random() % 8);
    if (random() % 16 == 0) dfu.select(static_cast<std::uint8_t>(random() % 2));
    if (random() % 8 == 0) block = 0;
    if (random() % 2 == 0) dfu.work();
    const std::size_t length = random() % 4 == 0 ? random() % data.size() : 64;
    const auto answer =
        dfu.handle({request, block}, std::span(data).first(random() % 5 == 0 ? 0 : length), length);
    ASSERT_LE(answer.bytes.size(), std::max<std::size_t>(length, kStatusReplyBytes));
    block = static_cast<std::uint16_t>(block + 1);
  }
  const auto held = slots.state(0).image;
  EXPECT_TRUE(std::equal(held.begin(), held.end(), first.begin(), first.end()));
  EXPECT_TRUE(slots.state(1).image.empty());
  EXPECT_FALSE(flash.misused());
}

TEST(DfuDevice, lost_block_is_noticed) {
  FlashModel flash(kTwoSlots);
  Slots slots(flash, kTwoSlots);
  DfuDevice dfu(slots);
  const std::vector<std::byte> data(64);
  EXPECT_FALSE(dfu.handle({DfuRequest::download, 0}, data, 0).stall);
  while (dfu.work()) {
  }
  static_cast<void>(dfu.handle({DfuRequest::get_status, 0}, {}, 6));
  EXPECT_TRUE(dfu.handle({DfuRequest::download, 2}, data, 0).stall);
  const auto status = dfu.handle({DfuRequest::get_status, 0}, {}, 6).bytes;
  EXPECT_EQ(status[0], static_cast<std::byte>(DfuStatus::address));
  EXPECT_EQ(status[4], static_cast<std::byte>(DfuState::error));
  EXPECT_FALSE(dfu.handle({DfuRequest::clear_status, 0}, {}, 0).stall);
  EXPECT_EQ(dfu.state(), DfuState::idle);
}

}  // namespace
}  // namespace palpate::hal::flash

// SPDX-License-Identifier: Apache-2.0
// Slots of a device that has a key: nothing unsigned, foreign or older is ever in use, whatever is
// written and whenever the power is cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "../support/signed_slots.hpp"
#include "hal/flash/dfu_device.hpp"
#include "hal/flash/slots.hpp"
#include "hal/simulator/flash_model.hpp"

namespace palpate::hal::flash {
namespace {

using namespace signed_test;

TEST(SignedSlots, signed_image_is_used_and_read_back_with_its_signature) {
  FlashModel flash(kLayout);
  const Bytes file = maker().signed_file(image(1), 5);
  Slots slots = with_five(flash, file);
  EXPECT_TRUE(holds(slots, 0, file));
  EXPECT_EQ(slots.state(0).image.size(), image(1).size());
  EXPECT_EQ(slots.state(0).counter, 5u);
  EXPECT_FALSE(flash.misused());
}

TEST(SignedSlots, device_without_a_key_takes_both_kinds) {
  FlashModel flash(kLayout);
  Slots slots(flash, kLayout);
  EXPECT_EQ(update(slots, 0, maker().signed_file(image(1), 5)), UpdateStatus::ok);
  EXPECT_EQ(slots.start(), 0);
  EXPECT_EQ(update(slots, 1, image(2)), UpdateStatus::ok);
  EXPECT_EQ(slots.start(), 1);
}

TEST(SignedSlots, what_is_not_to_be_used_is_refused_with_its_reason) {
  const Bytes file = maker().signed_file(image(1), 5);
  for (const Bad& bad : bad_files()) {
    FlashModel flash(kLayout);
    Slots slots = with_five(flash, file);
    EXPECT_EQ(update(slots, 1, bad.file), bad.status) << bad.what;
    EXPECT_EQ(slots.start(), 0) << bad.what;
    EXPECT_TRUE(slots.state(1).image.empty()) << bad.what;
  }
}

TEST(SignedSlots, same_counter_is_no_older_one) {
  FlashModel flash(kLayout);
  Slots slots = with_five(flash, maker().signed_file(image(1), 5));
  EXPECT_EQ(update(slots, 1, maker().signed_file(image(2), 5)), UpdateStatus::ok);
  EXPECT_EQ(slots.start(), 1);
}

TEST(SignedSlots, confirmed_newer_image_ends_the_older_one_for_good) {
  FlashModel flash(kLayout);
  Slots slots = with_five(flash, maker().signed_file(image(1), 5));
  ASSERT_EQ(update(slots, 1, maker().signed_file(image(2), 6)), UpdateStatus::ok);
  // Not confirmed: the older one is still what to fall back to.
  ASSERT_EQ(slots.start(), 1);
  EXPECT_TRUE(slots.state(0).usable);
  ASSERT_TRUE(slots.confirm());
  EXPECT_FALSE(slots.state(0).usable);
  // Even where the newer one is damaged: no image, and no force.
  ASSERT_TRUE(flash.erase(kLayout.slot_bytes() + 2 * kLayout.erase_bytes));
  EXPECT_EQ(slots.start(), kNone);
}

TEST(SignedSlots, image_that_never_passes_its_test_falls_back_to_the_older_one) {
  FlashModel flash(kLayout);
  Slots slots = with_five(flash, maker().signed_file(image(1), 5));
  ASSERT_EQ(update(slots, 1, maker().signed_file(image(2), 6)), UpdateStatus::ok);
  for (std::uint32_t i = 0; i < kMaxTries; ++i) EXPECT_EQ(slots.start(), 1);
  EXPECT_EQ(slots.start(), 0);
}

/// Written past the slot manager: by a program that has the flash itself.
void forge(FlashModel& flash, const Bytes& file) {
  SlotRules none;
  Slots careless(flash, kLayout, none);
  ASSERT_EQ(update(careless, 1, file), UpdateStatus::ok);
}

TEST(SignedSlots, record_that_was_forged_is_not_believed) {
  for (const Bad& bad : bad_files()) {
    if (bad.status == UpdateStatus::not_an_image) continue;
    FlashModel flash(kLayout);
    Slots slots = with_five(flash, maker().signed_file(image(1), 5));
    forge(flash, bad.file);
    EXPECT_EQ(slots.start(), 0) << bad.what;
  }
}

TEST(SignedSlots, image_beyond_the_engines_memory_is_refused) {
  FlashModel flash(kLayout);
  SlotRules small;
  small.engine_memory_bytes = 1000;
  small.engine_bytes = [](const ImageView&) noexcept { return std::size_t{1001}; };
  Slots slots(flash, kLayout, small);
  EXPECT_EQ(update(slots, 0, image(1)), UpdateStatus::too_demanding);
  EXPECT_EQ(slots.start(), kNone);
}

TEST(Counter, only_grows_through_any_cut_and_many_rounds) {
  constexpr std::uint32_t kOffset = kSlots * kLayout.slot_bytes();
  std::mt19937_64 random(4);
  FlashModel flash(kLayout, 9);
  std::uint64_t promised = 0, wanted = 0;
  for (int round = 0; round < 20'000; ++round) {
    Counter counter(flash, kOffset, kLayout.erase_bytes);
    if (random() % 3 == 0) flash.cut_power_after(1 + random() % 40);
    wanted += random() % 3;
    const bool raised = counter.raise(wanted);
    flash.restore_power();
    const std::uint64_t value = counter.value();
    ASSERT_GE(value, promised) << round;
    ASSERT_LE(value, wanted) << round;
    ASSERT_TRUE(!raised || value == wanted) << round;
    promised = value;
    ASSERT_FALSE(flash.misused()) << round;
  }
  EXPECT_GT(flash.erasures(), 1000u);
}

TEST(DfuDevice, reasons_of_a_refusal_reach_the_host) {
  const struct {
    Bytes file;
    DfuStatus status;
  } cases[] = {{bad_files()[0].file, DfuStatus::file}, {bad_files()[6].file, DfuStatus::vendor}};
  for (const auto& c : cases) {
    FlashModel flash(kLayout);
    Slots slots = with_five(flash, maker().signed_file(image(1), 5));
    DfuDevice dfu(slots);
    dfu.select(1);
    std::uint16_t block = 0;
    const std::span<const std::byte> file(c.file);
    for (std::size_t at = 0; at < file.size(); at += DfuDevice::kTransferBytes) {
      const auto part =
          file.subspan(at, std::min<std::size_t>(DfuDevice::kTransferBytes, file.size() - at));
      ASSERT_FALSE(dfu.handle({DfuRequest::download, block++}, part, 0).stall);
      while (dfu.work()) {
      }
      static_cast<void>(dfu.handle({DfuRequest::get_status, 0}, {}, kStatusReplyBytes));
    }
    ASSERT_FALSE(dfu.handle({DfuRequest::download, block}, {}, 0).stall);
    EXPECT_FALSE(dfu.work());
    const auto status = dfu.handle({DfuRequest::get_status, 0}, {}, kStatusReplyBytes).bytes;
    EXPECT_EQ(status[0], static_cast<std::byte>(c.status));
  }
}

}  // namespace
}  // namespace palpate::hal::flash

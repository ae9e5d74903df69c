// SPDX-License-Identifier: Apache-2.0
#include "hal/flash/slots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "../support/tiny_image.hpp"
#include "hal/simulator/flash_model.hpp"

namespace palpate::hal::flash {
namespace {

using palpate::test::AlignedBytes;
using simulator::FlashModel;

constexpr SlotLayout kLayout{256, 12};

AlignedBytes image(double radius_m) {
  return palpate::test::seal(palpate::test::parts_of(
      {palpate::test::triangle_part({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, radius_m));
}

UpdateStatus update(Slots& slots, std::uint8_t slot, std::span<const std::byte> bytes) {
  const UpdateStatus begun = slots.begin(slot);
  if (begun != UpdateStatus::ok) return begun;
  // Pieces of no particular size.
  for (std::size_t at = 0; at < bytes.size(); at += 100) {
    const auto status =
        slots.write(bytes.subspan(at, std::min<std::size_t>(100, bytes.size() - at)));
    if (status != UpdateStatus::ok) return status;
  }
  return slots.finish();
}

bool holds(const Slots& slots, std::uint8_t slot, const AlignedBytes& bytes) {
  const auto held = slots.state(slot).image;
  return std::equal(held.begin(), held.end(), bytes.begin(), bytes.end());
}

/// Runs `old_image` from slot 0, confirmed.
Slots with_old(FlashModel& flash, const AlignedBytes& old_image) {
  Slots slots(flash, kLayout);
  EXPECT_EQ(update(slots, 0, old_image), UpdateStatus::ok);
  EXPECT_EQ(slots.start(), 0);
  EXPECT_TRUE(slots.confirm());
  return slots;
}

TEST(Slots, empty_flash_has_no_image) {
  FlashModel flash(kLayout);
  Slots slots(flash, kLayout);
  EXPECT_EQ(slots.start(), kNone);
  EXPECT_FALSE(slots.confirm());
}

TEST(Slots, update_is_used_from_the_next_start_on) {
  FlashModel flash(kLayout);
  const AlignedBytes old_image = image(1), new_image = image(2);
  Slots slots = with_old(flash, old_image);
  EXPECT_EQ(update(slots, 1, new_image), UpdateStatus::ok);
  EXPECT_EQ(slots.active(), 0);
  EXPECT_EQ(slots.start(), 1);
  EXPECT_TRUE(holds(slots, 1, new_image));
  EXPECT_TRUE(slots.confirm());
  EXPECT_TRUE(slots.confirm());
  EXPECT_EQ(slots.state(1).sequence, 2u);
  EXPECT_FALSE(flash.misused());
}

TEST(Slots, slot_in_use_cannot_be_written) {
  FlashModel flash(kLayout);
  Slots slots = with_old(flash, image(1));
  EXPECT_EQ(slots.begin(0), UpdateStatus::in_use);
  EXPECT_TRUE(holds(slots, 0, image(1)));
}

TEST(Slots, what_is_no_image_is_not_committed) {
  FlashModel flash(kLayout);
  Slots slots = with_old(flash, image(1));
  AlignedBytes bad = image(2);
  bad[700] ^= std::byte{1};
  EXPECT_EQ(update(slots, 1, bad), UpdateStatus::not_an_image);
  EXPECT_EQ(update(slots, 1, std::span(bad).first(bad.size() - 64)), UpdateStatus::not_an_image);
  EXPECT_EQ(slots.start(), 0);
}

TEST(Slots, more_than_the_slot_holds_is_refused) {
  FlashModel flash(kLayout);
  Slots slots(flash, kLayout);
  ASSERT_EQ(slots.begin(0), UpdateStatus::ok);
  const std::vector<std::byte> bytes(kLayout.capacity() + 1);
  EXPECT_EQ(slots.write(bytes), UpdateStatus::too_large);
  EXPECT_EQ(slots.finish(), UpdateStatus::not_begun);
}

TEST(Slots, steps_out_of_order_are_refused) {
  FlashModel flash(kLayout);
  Slots slots(flash, kLayout);
  EXPECT_EQ(slots.write({}), UpdateStatus::not_begun);
  EXPECT_EQ(slots.finish(), UpdateStatus::not_begun);
  EXPECT_EQ(slots.begin(2), UpdateStatus::too_large);
}

TEST(Slots, image_that_is_never_confirmed_falls_back_after_its_tries) {
  FlashModel flash(kLayout);
  Slots slots = with_old(flash, image(1));
  ASSERT_EQ(update(slots, 1, image(2)), UpdateStatus::ok);
  for (std::uint32_t i = 0; i < kMaxTries; ++i) EXPECT_EQ(slots.start(), 1);
  EXPECT_EQ(slots.start(), 0);
  // And the next update goes to the slot that was passed over, with a number of its own.
  ASSERT_EQ(update(slots, 1, image(3)), UpdateStatus::ok);
  EXPECT_EQ(slots.start(), 1);
  EXPECT_TRUE(holds(slots, 1, image(3)));
}

TEST(Slots, damaged_newer_image_falls_back) {
  FlashModel flash(kLayout);
  Slots slots = with_old(flash, image(1));
  ASSERT_EQ(update(slots, 1, image(2)), UpdateStatus::ok);
  const std::uint32_t somewhere = kLayout.slot_bytes() + 2 * kLayout.erase_bytes;
  ASSERT_TRUE(flash.erase(somewhere));
  EXPECT_EQ(slots.start(), 0);
}

TEST(Slots, random_flash_holds_no_image) {
  for (std::uint64_t seed = 1; seed < 200; ++seed) {
    FlashModel flash(kLayout, seed);
    for (std::uint32_t at = 0; at < 2 * kLayout.slot_bytes(); at += kLayout.erase_bytes) {
      flash.cut_power_after(1);
      static_cast<void>(flash.erase(at));
    }
    flash.restore_power();
    Slots slots(flash, kLayout);
    EXPECT_EQ(slots.start(), kNone);
  }
}

/// What a device does with a new image, from the update over its first start to the self-test.
void whole_update(Slots& slots, const AlignedBytes& new_image) {
  const std::uint8_t target = slots.active() == 0 ? 1 : 0;
  if (update(slots, target, new_image) != UpdateStatus::ok) return;
  if (slots.start() == target) slots.confirm();
}

/// After any cuts the device starts with one of both images, whole; returns whether with the new.
bool starts_whole(FlashModel& flash, const AlignedBytes& old_image, const AlignedBytes& new_image) {
  flash.restore_power();
  Slots slots(flash, kLayout);
  const std::uint8_t active = slots.start();
  EXPECT_NE(active, kNone);
  if (active == kNone) return false;
  const bool is_new = holds(slots, active, new_image);
  EXPECT_TRUE(is_new || holds(slots, active, old_image));
  EXPECT_FALSE(flash.misused());
  return is_new;
}

std::uint64_t steps_of_an_update(const AlignedBytes& old_image, const AlignedBytes& new_image) {
  FlashModel flash(kLayout);
  Slots slots = with_old(flash, old_image);
  const std::uint64_t before = flash.steps();
  whole_update(slots, new_image);
  return flash.steps() - before;
}

TEST(SlotsPowerCut, any_byte_of_an_update_leaves_one_whole_image) {
  const AlignedBytes old_image = image(1), new_image = image(2);
  const std::uint64_t steps = steps_of_an_update(old_image, new_image);
  ASSERT_GT(steps, new_image.size());
  std::uint64_t with_new = 0;
  for (std::uint64_t cut = 1; cut <= steps; ++cut) {
    FlashModel flash(kLayout, cut);
    Slots slots = with_old(flash, old_image);
    flash.cut_power_after(cut);
    whole_update(slots, new_image);
    if (starts_whole(flash, old_image, new_image)) ++with_new;
    if (testing::Test::HasFailure()) FAIL() << "cut after " << cut << " of " << steps;
  }
  EXPECT_GT(with_new, 0u);
  EXPECT_LT(with_new, 100u);  // only after the commit word
}

TEST(SlotsPowerCut, second_cut_in_the_start_or_the_repetition_leaves_one_whole_image) {
  const AlignedBytes old_image = image(1), new_image = image(2);
  const std::uint64_t steps = steps_of_an_update(old_image, new_image);
  std::mt19937_64 random(7);
  for (std::uint64_t cut = 1; cut <= steps; ++cut) {
    for (int sample = 0; sample < 12; ++sample) {
      FlashModel flash(kLayout, cut * 100 + static_cast<std::uint64_t>(sample));
      {
        Slots slots = with_old(flash, old_image);
        flash.cut_power_after(cut);
        whole_update(slots, new_image);
      }
      // Half of the second cuts fall into the start's own writing.
      flash.cut_power_after(1 + random() % (sample % 2 == 0 ? 2 * kProgramBytes : steps));
      {
        Slots slots(flash, kLayout);
        if (slots.start() != kNone) whole_update(slots, new_image);
      }
      starts_whole(flash, old_image, new_image);
      if (testing::Test::HasFailure()) FAIL() << "cut after " << cut << ", sample " << sample;
    }
  }
}

TEST(SlotsPowerCut, first_image_ever_is_whole_or_declared_missing) {
  const AlignedBytes first = image(1);
  for (std::uint64_t cut = 1; cut < first.size() + 200; ++cut) {
    FlashModel flash(kLayout, cut);
    {
      Slots slots(flash, kLayout);
      flash.cut_power_after(cut);
      if (update(slots, 0, first) == UpdateStatus::ok && slots.start() == 0) slots.confirm();
    }
    flash.restore_power();
    Slots slots(flash, kLayout);
    const std::uint8_t active = slots.start();
    ASSERT_TRUE(active == kNone || holds(slots, active, first)) << cut;
    // Either way the next update works.
    ASSERT_EQ(update(slots, active == 0 ? 1 : 0, first), UpdateStatus::ok);
    ASSERT_NE(slots.start(), kNone);
    ASSERT_FALSE(flash.misused());
  }
}

}  // namespace
}  // namespace palpate::hal::flash

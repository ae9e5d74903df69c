// SPDX-License-Identifier: Apache-2.0
// Cuts of power while a device with a key is given images, right ones and wrong ones. Every
// PALPATE_CUT_STRIDE-th byte: signatures take their time.
#include <gtest/gtest.h>

#include <random>

#include "../support/signed_slots.hpp"

namespace palpate::hal::flash {
namespace {

using namespace signed_test;

constexpr std::uint64_t kStride = PALPATE_CUT_STRIDE;

/// What with_five() leaves in the flash, without proving every signature on the way.
Slots running_five(FlashModel& flash, const Bytes& file) {
  {
    Slots careless(flash, kLayout);
    EXPECT_EQ(update(careless, 0, file), UpdateStatus::ok);
    EXPECT_EQ(careless.start(), 0);
    EXPECT_TRUE(careless.confirm());
  }
  Slots slots(flash, kLayout, rules());
  EXPECT_EQ(slots.start(), 0);
  return slots;
}

/// What a device does with a file, from the update over its first start to the self-test.
void whole_update(Slots& slots, const Bytes& file) {
  const std::uint8_t target = slots.active() == 0 ? 1 : 0;
  if (update(slots, target, file) != UpdateStatus::ok) return;
  if (slots.start() == target) slots.confirm();
}

std::uint64_t steps_of_an_update(const Bytes& old_file, const Bytes& new_file) {
  FlashModel flash(kLayout);
  Slots slots = running_five(flash, old_file);
  const std::uint64_t before = flash.steps();
  whole_update(slots, new_file);
  return flash.steps() - before;
}

TEST(SignedPowerCut, any_byte_of_a_signed_update_leaves_one_whole_signed_image) {
  const Bytes old_file = maker().signed_file(image(1), 5);
  const Bytes new_file = maker().signed_file(image(2), 6);
  const std::uint64_t steps = steps_of_an_update(old_file, new_file);
  ASSERT_GT(steps, new_file.size());
  std::uint64_t with_new = 0;
  for (std::uint64_t cut = 1; cut <= steps; cut += kStride) {
    FlashModel flash(kLayout, cut);
    {
      Slots slots = running_five(flash, old_file);
      flash.cut_power_after(cut);
      whole_update(slots, new_file);
    }
    flash.restore_power();
    Slots slots(flash, kLayout, rules());
    const std::uint8_t active = slots.start();
    ASSERT_NE(active, kNone) << cut;
    const bool is_new = holds(slots, active, new_file);
    ASSERT_TRUE(is_new || holds(slots, active, old_file)) << cut;
    // Once the new one counts as confirmed the old one never comes back.
    ASSERT_EQ(slots.state(0).usable, !slots.state(1).confirmed) << cut;
    ASSERT_FALSE(flash.misused()) << cut;
    with_new += is_new ? 1 : 0;
  }
  EXPECT_GT(with_new, 0u);
}

// Each bad file, cut at each byte, and cut again at another one while it is tried again.
TEST(SignedPowerCut, no_cut_lets_an_unsigned_or_older_image_in) {
  const Bytes old_file = maker().signed_file(image(1), 5);
  std::mt19937_64 random(3);
  for (const Bad& bad : bad_files()) {
    const std::uint64_t steps = steps_of_an_update(old_file, bad.file);
    for (std::uint64_t cut = 1; cut <= steps + 1; cut += kStride) {
      FlashModel flash(kLayout, cut);
      {
        Slots slots = running_five(flash, old_file);
        flash.cut_power_after(cut);
        whole_update(slots, bad.file);
      }
      flash.cut_power_after(1 + random() % steps);
      {
        Slots slots(flash, kLayout, rules());
        if (slots.start() != kNone) whole_update(slots, bad.file);
      }
      flash.restore_power();
      Slots slots(flash, kLayout, rules());
      ASSERT_EQ(slots.start(), 0) << bad.what << ", cut after " << cut;
      ASSERT_TRUE(holds(slots, 0, old_file)) << bad.what << ", cut after " << cut;
    }
  }
}

}  // namespace
}  // namespace palpate::hal::flash

// SPDX-License-Identifier: Apache-2.0
// Slots of a device that has a key, and everything that it has to refuse.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "hal/flash/slots.hpp"
#include "hal/simulator/flash_model.hpp"
#include "signer.hpp"
#include "tiny_image.hpp"

namespace palpate::hal::flash::signed_test {

using palpate::test::AlignedBytes;
using signature::test::Signer;
using simulator::FlashModel;
using Bytes = std::vector<std::byte>;

inline constexpr SlotLayout kLayout{256, 12};

inline const Signer& maker() {
  static const Signer kMaker(1);
  return kMaker;
}

inline AlignedBytes image(double radius_m) {
  return palpate::test::seal(palpate::test::parts_of(
      {palpate::test::triangle_part({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, radius_m));
}

inline SlotRules rules() {
  SlotRules out;
  out.key = maker().key;
  return out;
}

inline UpdateStatus update(Slots& slots, std::uint8_t slot, std::span<const std::byte> bytes) {
  const UpdateStatus begun = slots.begin(slot);
  if (begun != UpdateStatus::ok) return begun;
  const UpdateStatus written = slots.write(bytes);
  return written == UpdateStatus::ok ? slots.finish() : written;
}

/// Runs an image with counter 5 from slot 0, confirmed.
inline Slots with_five(FlashModel& flash, const Bytes& file) {
  Slots slots(flash, kLayout, rules());
  EXPECT_EQ(update(slots, 0, file), UpdateStatus::ok);
  EXPECT_EQ(slots.start(), 0);
  EXPECT_TRUE(slots.confirm());
  return slots;
}

inline bool holds(const Slots& slots, std::uint8_t slot, const Bytes& file) {
  const auto held = slots.state(slot).file;
  return std::equal(held.begin(), held.end(), file.begin(), file.end());
}

struct Bad {
  const char* what;
  Bytes file;
  UpdateStatus status;
};

/// Everything that a device with an image of counter 5 has to refuse.
inline std::vector<Bad> bad_files() {
  const AlignedBytes plain = image(2);
  const Bytes right = maker().signed_file(plain, 6);
  Bytes other_counter = right, other_signature = right, other_magic = right;
  other_counter[plain.size() + 16] = std::byte{7};
  other_signature.back() ^= std::byte{1};
  other_magic[plain.size()] ^= std::byte{1};
  Bytes borrowed = maker().signed_file(image(3), 6);  // a right block, of another image
  std::copy(plain.begin(), plain.end(), borrowed.begin());
  return {{"unsigned", Bytes(plain.begin(), plain.end()), UpdateStatus::not_signed},
          {"of another key", Signer(2).signed_file(plain, 6), UpdateStatus::not_signed},
          {"counter changed", other_counter, UpdateStatus::not_signed},
          {"signature changed", other_signature, UpdateStatus::not_signed},
          {"block of another image", borrowed, UpdateStatus::not_signed},
          {"no block", other_magic, UpdateStatus::not_an_image},
          {"older", maker().signed_file(plain, 4), UpdateStatus::outdated}};
}

}  // namespace palpate::hal::flash::signed_test

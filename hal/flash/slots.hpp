// SPDX-License-Identifier: Apache-2.0
// Two slots of flash for images, for firmware: an update is written to the one that is not in use,
// and a cut of power at any byte leaves one whole image. Freestanding.
//
// Images are used where they lie and never moved. docs/PROTOCOL.md, "Images and updates", gives the
// record of a slot and the order of writing. What makes it safe:
//   - the slot in use is never written;
//   - the record is erased first and its commit word written last, so that half an image is none;
//   - an image counts only where record, hash and structure are all right, and where there is a key
//     the signature and its counter, looked at anew each start;
//   - a word that means "yes" is one that is not erased throughout, or (commit) one that is right
//     throughout: whichever is the safe reading of a word that a cut of power left half written.
//
// Source: the direct-XIP mode of MCUboot, without swap and scratch. Departure: the words are judged
// as above, for a partly written word matched no row of its state table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/flash/counter.hpp"
#include "hal/flash/flash_memory.hpp"
#include "hal/signature/signed_image.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::hal::flash {

inline constexpr std::uint32_t kMaxTries = 3;  ///< starts that an image has to be confirmed in
inline constexpr std::uint8_t kSlots = 2;
inline constexpr std::uint8_t kNone = 0xff;  ///< no slot

/// Both slots lie one after the other from the start of the flash: one erase unit of record, then
/// the image. Behind them lies the security counter.
struct SlotLayout {
  std::uint32_t erase_bytes = 4096;  ///< of one erase unit: at least 256, a multiple of 64
  std::uint32_t image_units = 32;    ///< erase units for an image
  [[nodiscard]] constexpr std::uint32_t capacity() const noexcept {
    return erase_bytes * image_units;
  }
  [[nodiscard]] constexpr std::uint32_t slot_bytes() const noexcept {
    return erase_bytes + capacity();
  }
  [[nodiscard]] constexpr std::uint32_t flash_bytes() const noexcept {
    return kSlots * slot_bytes() + kCounterUnits * erase_bytes;
  }
};

/// What a device asks of an image beyond its being sound.
struct SlotRules {
  /// It is signed with the other half of this key, with a security counter that is not below the
  /// greatest of the images that were confirmed. Absent: signatures are not looked at.
  std::optional<signature::PublicKey> key;
  /// Memory that an engine for the image may need; 0: the device has no engine.
  std::uint64_t engine_memory_bytes = 0;
  /// What it does need. Null where there is no engine.
  std::size_t (*engine_bytes)(const ImageView& image) noexcept = nullptr;
};

enum class [[nodiscard]] UpdateStatus : std::uint8_t{
    ok,
    in_use,        ///< this slot's image is the one in use
    not_begun,     ///< write or finish without begin
    too_large,     ///< more bytes than the slot holds
    erase_failed,  ///< the flash refused
    write_failed,  ///< the flash refused
    not_an_image,  ///< what was written is no sound image
    not_signed,    ///< or not with the device's key
    outdated,      ///< its security counter is below the device's
    too_demanding  ///< an engine for it needs more memory than the device has
};

/// What is known of a slot.
struct SlotState {
  bool usable = false;  ///< a whole image; its tries are not used up
  bool confirmed = false;
  std::uint32_t tries = 0;
  std::uint64_t sequence = 0;
  std::uint64_t counter = 0;         ///< of its signature
  std::span<const std::byte> image;  ///< empty where there is none that keeps the rules
  std::span<const std::byte> file;   ///< as it was written: with its signature
};

class Slots {
 public:
  /// The flash must outlive this and have SlotLayout::flash_bytes().
  Slots(FlashMemory& flash, const SlotLayout& layout, const SlotRules& rules = {}) noexcept
      : flash_(flash),
        layout_(layout),
        rules_(rules),
        counter_(flash, kSlots * layout.slot_bytes(), layout.erase_bytes) {}

  /// Once at each start of the device: chooses the newest usable image and, where it is not
  /// confirmed yet, records that it is tried. @return the slot in use from now on, or kNone Cost:
  /// at most two passes over each image.
  std::uint8_t start() noexcept;

  /// The self-test of the image in use has passed: from now on none with a lower security counter
  /// is accepted. False where there is none or the flash refused.
  bool confirm() noexcept;

  [[nodiscard]] std::uint8_t active() const noexcept { return active_; }

  /// Proves a slot's record, image and signature. Cost: one pass of validate(), and of
  /// is_signed_by() where there is a key.
  [[nodiscard]] SlotState state(std::uint8_t slot) const noexcept;

  /// Begins an update of a slot. Aborts one that is under way.
  UpdateStatus begin(std::uint8_t slot) noexcept;
  /// Erase units that are erased before so many more bytes of the update can be written: the record
  /// first, so that the slot holds no image any more.
  [[nodiscard]] std::uint32_t erasures_before(std::size_t bytes) const noexcept;
  /// Erases the next of them.
  UpdateStatus erase_next() noexcept;
  /// Appends bytes of the image; erases what has to be and is not yet.
  UpdateStatus write(std::span<const std::byte> bytes) noexcept;
  /// Proves what was written and commits it. The slot is used from the next start on.
  UpdateStatus finish() noexcept;
  /// Gives an update up; its slot stays without an image.
  void abort() noexcept { updating_ = kNone; }

 private:
  [[nodiscard]] std::uint32_t offset_of(std::uint8_t slot) const noexcept {
    return slot * layout_.slot_bytes();
  }
  [[nodiscard]] std::uint32_t image_offset(std::uint8_t slot) const noexcept {
    return offset_of(slot) + layout_.erase_bytes;
  }
  [[nodiscard]] std::span<const std::byte> record_of(std::uint8_t slot) const noexcept;
  [[nodiscard]] std::uint64_t newest_sequence() const noexcept;
  UpdateStatus flush() noexcept;
  /// Whether the device may use what a file holds.
  UpdateStatus judge(const signature::Contents& contents) const noexcept;
  [[nodiscard]] bool raise_counter() noexcept;

  FlashMemory& flash_;
  SlotLayout layout_;
  SlotRules rules_;
  Counter counter_;
  std::uint8_t active_ = kNone;
  std::uint64_t active_counter_ = 0;  ///< of its signature
  std::uint8_t updating_ = kNone;
  std::uint32_t erased_ = 0;   ///< erase units of the update's slot, from its record on
  std::uint32_t written_ = 0;  ///< bytes of the update taken so far, with those in the buffer
  std::size_t buffered_ = 0;
  std::array<std::byte, kProgramBytes> buffer_{};
};

}  // namespace palpate::hal::flash

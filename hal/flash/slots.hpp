// SPDX-License-Identifier: Apache-2.0
// Two slots of flash for images, for firmware: an update is written to the one that is not in use,
// and a cut of power at any byte leaves one whole image. Freestanding.
//
// Images are used where they lie and never moved. docs/PROTOCOL.md, "Images and updates", gives the
// record of a slot and the order of writing. What makes it safe:
//   - the slot in use is never written;
//   - the record is erased first and its commit word written last, so that half an image is none;
//   - an image counts only where record, hash and structure are all right, looked at anew each
//   start;
//   - a word that means "yes" is one that is not erased throughout, or (commit) one that is right
//     throughout: whichever is the safe reading of a word that a cut of power left half written.
//
// Source: the direct-XIP mode of MCUboot, without swap and scratch. Departure: the words are judged
// as above, for a partly written word matched no row of its state table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::hal::flash {

/// Flash as firmware reaches it: erased bytes are 0xff; a program unit is written once between two
/// erasures.
class FlashMemory {
 public:
  FlashMemory() = default;
  FlashMemory(const FlashMemory&) = delete;
  FlashMemory& operator=(const FlashMemory&) = delete;
  FlashMemory(FlashMemory&&) = delete;
  FlashMemory& operator=(FlashMemory&&) = delete;

  /// Erases one erase unit. @param offset  of its first byte
  [[nodiscard]] virtual bool erase(std::uint32_t offset) noexcept = 0;
  /// Writes whole program units that are erased.
  [[nodiscard]] virtual bool program(std::uint32_t offset,
                                     std::span<const std::byte> bytes) noexcept = 0;
  /// All of it, mapped; the first byte on a 64-byte boundary.
  [[nodiscard]] virtual std::span<const std::byte> bytes() const noexcept = 0;

 protected:
  ~FlashMemory() = default;
};

inline constexpr std::size_t kProgramBytes = 32;  ///< one program unit, or several of them
inline constexpr std::uint32_t kMaxTries = 3;     ///< starts that an image has to be confirmed in
inline constexpr std::uint8_t kSlots = 2;
inline constexpr std::uint8_t kNone = 0xff;  ///< no slot

/// Both slots lie one after the other from the start of the flash: one erase unit of record, then
/// the image.
struct SlotLayout {
  std::uint32_t erase_bytes = 4096;  ///< of one erase unit: at least 256, a multiple of 64
  std::uint32_t image_units = 32;    ///< erase units for an image
  [[nodiscard]] constexpr std::uint32_t capacity() const noexcept {
    return erase_bytes * image_units;
  }
  [[nodiscard]] constexpr std::uint32_t slot_bytes() const noexcept {
    return erase_bytes + capacity();
  }
};

enum class [[nodiscard]] UpdateStatus : std::uint8_t{
    ok,
    in_use,        ///< this slot's image is the one in use
    not_begun,     ///< write or finish without begin
    too_large,     ///< more bytes than the slot holds
    erase_failed,  ///< the flash refused
    write_failed,  ///< the flash refused
    not_an_image   ///< what was written is no sound image
};

/// What is known of a slot.
struct SlotState {
  bool usable = false;  ///< a whole image; its tries are not used up
  bool confirmed = false;
  std::uint32_t tries = 0;
  std::uint64_t sequence = 0;
  std::span<const std::byte> image;  ///< empty where there is no whole one
};

class Slots {
 public:
  /// The flash must outlive this and have room for both slots.
  Slots(FlashMemory& flash, const SlotLayout& layout) noexcept : flash_(flash), layout_(layout) {}

  /// Once at each start of the device: chooses the newest usable image and, where it is not
  /// confirmed yet, records that it is tried. @return the slot in use from now on, or kNone Cost:
  /// at most two passes over each image.
  std::uint8_t start() noexcept;

  /// The self-test of the image in use has passed. False where there is none or the flash refused.
  bool confirm() noexcept;

  [[nodiscard]] std::uint8_t active() const noexcept { return active_; }

  /// Proves a slot's record and image. Cost: one pass of validate().
  [[nodiscard]] SlotState state(std::uint8_t slot) const noexcept;

  /// Erases a slot for an update. Aborts one that is under way.
  UpdateStatus begin(std::uint8_t slot) noexcept;
  /// Appends bytes of the image.
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

  FlashMemory& flash_;
  SlotLayout layout_;
  std::uint8_t active_ = kNone;
  std::uint8_t updating_ = kNone;
  std::uint32_t written_ = 0;  ///< bytes of the update taken so far, with those in the buffer
  std::size_t buffered_ = 0;
  std::array<std::byte, kProgramBytes> buffer_{};
};

}  // namespace palpate::hal::flash

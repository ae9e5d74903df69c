// SPDX-License-Identifier: Apache-2.0
#include "hal/flash/slots.hpp"

namespace palpate::hal::flash {
namespace {

constexpr std::byte kCommitByte{0xc3};

// Offsets within a record; each group is one program unit.
constexpr std::uint32_t kHeaderAt = 0;
constexpr std::uint32_t kCommitAt = 32;
constexpr std::uint32_t kTriedAt = 64;
constexpr std::uint32_t kConfirmedAt = kTriedAt + kMaxTries * kProgramBytes;

constexpr std::uint64_t kMagic = 0x544f4c53504c4150;  // "PALPSLOT"

constexpr ProgramUnit unit_of(std::byte value) noexcept {
  ProgramUnit unit{};
  for (std::byte& b : unit) b = value;
  return unit;
}

}  // namespace

std::uint8_t Slots::start() noexcept {
  active_ = updating_ = kNone;
  std::array<SlotState, kSlots> states;
  for (std::uint8_t s = 0; s < kSlots; ++s) states[s] = state(s);
  for (std::uint8_t round = 0; round < kSlots; ++round) {
    const std::uint8_t newest =
        states[1].usable && (!states[0].usable || states[1].sequence > states[0].sequence) ? 1 : 0;
    SlotState& chosen = states[newest];
    if (!chosen.usable) break;
    if (chosen.confirmed ||
        flash_.program(
            offset_of(newest) + kTriedAt + chosen.tries * static_cast<std::uint32_t>(kProgramBytes),
            unit_of(std::byte{0}))) {
      active_ = newest;
      active_counter_ = chosen.counter;
      // The power may have been cut between the word of confirm() and the counter.
      if (chosen.confirmed && !raise_counter()) active_ = kNone;
      break;
    }
    // A start that cannot be recorded could be repeated for ever.
    chosen.usable = false;
  }
  return active_;
}

bool Slots::confirm() noexcept {
  if (active_ == kNone) return false;
  const auto word = record_of(active_).subspan(kConfirmedAt, kProgramBytes);
  const bool confirmed = !all_are(word, kErased) ||
                         flash_.program(offset_of(active_) + kConfirmedAt, unit_of(std::byte{0}));
  return confirmed && raise_counter();
}

bool Slots::raise_counter() noexcept { return !rules_.key || counter_.raise(active_counter_); }

UpdateStatus Slots::judge(const signature::Contents& contents) const noexcept {
  ImageView view;
  if (validate(contents.image, view) != Status::ok) return UpdateStatus::not_an_image;
  if (rules_.engine_bytes != nullptr && rules_.engine_bytes(view) > rules_.engine_memory_bytes) {
    return UpdateStatus::too_demanding;
  }
  if (!rules_.key) return UpdateStatus::ok;
  if (!signature::is_signed_by(*rules_.key, contents)) return UpdateStatus::not_signed;
  return contents.counter < counter_.value() ? UpdateStatus::outdated : UpdateStatus::ok;
}

SlotState Slots::state(std::uint8_t slot) const noexcept {
  SlotState out;
  const auto record = record_of(slot);
  const auto header = record.subspan(kHeaderAt, kProgramBytes);
  const bool committed = all_are(record.subspan(kCommitAt, kProgramBytes), kCommitByte);
  Entry entry{kMagic};  // the update's sequence and the bytes that were written
  if (!committed || !entry.read(header) || entry.second > layout_.capacity()) return out;
  const auto file = flash_.bytes().subspan(image_offset(slot), entry.second);
  const signature::Contents contents = signature::contents_of(file);
  if (judge(contents) != UpdateStatus::ok) return out;

  out.file = file;
  out.image = contents.image;
  out.counter = contents.counter;
  out.sequence = entry.first;
  out.confirmed = !all_are(record.subspan(kConfirmedAt, kProgramBytes), kErased);
  while (out.tries < kMaxTries &&
         !all_are(record.subspan(kTriedAt + out.tries * kProgramBytes, kProgramBytes), kErased)) {
    ++out.tries;
  }
  out.usable = out.confirmed || out.tries < kMaxTries;
  return out;
}

UpdateStatus Slots::begin(std::uint8_t slot) noexcept {
  updating_ = kNone;
  if (slot >= kSlots) return UpdateStatus::too_large;
  if (slot == active_) return UpdateStatus::in_use;
  updating_ = slot;
  erased_ = 0;
  written_ = 0;
  buffered_ = 0;
  return UpdateStatus::ok;
}

std::uint32_t Slots::erasures_before(std::size_t bytes) const noexcept {
  if (updating_ == kNone || bytes > layout_.capacity() - written_) return 0;
  const std::uint32_t end = written_ + static_cast<std::uint32_t>(bytes);
  const std::uint32_t needed = 1 + (end + layout_.erase_bytes - 1) / layout_.erase_bytes;
  return needed > erased_ ? needed - erased_ : 0;
}

UpdateStatus Slots::erase_next() noexcept {
  if (updating_ == kNone) return UpdateStatus::not_begun;
  if (flash_.erase(offset_of(updating_) + erased_ * layout_.erase_bytes)) {
    ++erased_;
    return UpdateStatus::ok;
  }
  abort();
  return UpdateStatus::erase_failed;
}

UpdateStatus Slots::write(std::span<const std::byte> bytes) noexcept {
  if (updating_ == kNone) return UpdateStatus::not_begun;
  if (bytes.size() > layout_.capacity() - written_) {
    abort();
    return UpdateStatus::too_large;
  }
  while (erasures_before(bytes.size()) > 0) {
    const UpdateStatus erased = erase_next();
    if (erased != UpdateStatus::ok) return erased;
  }
  while (!bytes.empty()) {
    // Whole units go from where they are; the buffer is for what a block leaves over.
    const std::size_t whole = buffered_ == 0 ? bytes.size() / kProgramBytes * kProgramBytes : 0;
    if (whole > 0) {
      if (!flash_.program(image_offset(updating_) + written_, bytes.first(whole))) {
        abort();
        return UpdateStatus::write_failed;
      }
      written_ += static_cast<std::uint32_t>(whole);
      bytes = bytes.subspan(whole);
      continue;
    }
    buffer_[buffered_++] = bytes.front();
    ++written_;
    bytes = bytes.subspan(1);
    if (buffered_ < kProgramBytes) continue;
    const UpdateStatus status = flush();
    if (status != UpdateStatus::ok) return status;
  }
  return UpdateStatus::ok;
}

UpdateStatus Slots::finish() noexcept {
  if (updating_ == kNone) return UpdateStatus::not_begun;
  const UpdateStatus flushed = flush();
  if (flushed != UpdateStatus::ok) return flushed;
  const std::uint8_t slot = updating_;
  abort();
  const std::uint32_t at = offset_of(slot);
  const auto file = flash_.bytes().subspan(image_offset(slot), written_);
  const UpdateStatus judged = judge(signature::contents_of(file));
  if (judged != UpdateStatus::ok) return judged;
  const bool recorded =
      flash_.program(at + kHeaderAt, Entry{kMagic, newest_sequence() + 1, written_}.bytes()) &&
      flash_.program(at + kCommitAt, unit_of(kCommitByte));
  return recorded ? UpdateStatus::ok : UpdateStatus::write_failed;
}

UpdateStatus Slots::flush() noexcept {
  if (buffered_ == 0) return UpdateStatus::ok;
  for (std::size_t i = buffered_; i < kProgramBytes; ++i) buffer_[i] = kErased;
  const std::uint32_t behind = written_ - static_cast<std::uint32_t>(buffered_);
  buffered_ = 0;
  if (flash_.program(image_offset(updating_) + behind, buffer_)) {
    return UpdateStatus::ok;
  }
  abort();
  return UpdateStatus::write_failed;
}

std::span<const std::byte> Slots::record_of(std::uint8_t slot) const noexcept {
  return flash_.bytes().subspan(offset_of(slot), layout_.erase_bytes);
}

std::uint64_t Slots::newest_sequence() const noexcept {
  std::uint64_t newest = 0;
  // Also of an image that is not to be used: numbers only have to grow.
  for (std::uint8_t slot = 0; slot < kSlots; ++slot) {
    Entry entry{kMagic};
    const bool known = entry.read(record_of(slot).subspan(kHeaderAt, kProgramBytes));
    if (known && entry.first > newest) newest = entry.first;
  }
  return newest;
}

}  // namespace palpate::hal::flash

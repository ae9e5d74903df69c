// SPDX-License-Identifier: Apache-2.0
// Flash in a file, for hosts: the slots of a device whose flash is a disk, with the same rules.
#pragma once

#include <cstdint>
#include <filesystem>

#include "hal/flash/slots.hpp"

namespace palpate::hal::flash {

class FileFlash final : public FlashMemory {
 public:
  /// Opens the file or makes it, erased. Throws std::system_error where that fails or the file has
  /// another size.
  FileFlash(const std::filesystem::path& file, const SlotLayout& layout);
  ~FileFlash();
  FileFlash(const FileFlash&) = delete;
  FileFlash& operator=(const FileFlash&) = delete;
  FileFlash(FileFlash&&) = delete;
  FileFlash& operator=(FileFlash&&) = delete;

  /// Each is on the disk when it returns; false where the disk did not take it, or what is to be
  /// written is not erased.
  [[nodiscard]] bool erase(std::uint32_t offset) noexcept override;
  [[nodiscard]] bool program(std::uint32_t offset,
                             std::span<const std::byte> bytes) noexcept override;
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept override {
    return {memory_, size_};
  }

 private:
  [[nodiscard]] bool store(std::uint32_t offset, std::size_t length) noexcept;

  SlotLayout layout_;
  std::size_t size_;
  std::byte* memory_ = nullptr;  ///< the file, mapped
};

}  // namespace palpate::hal::flash

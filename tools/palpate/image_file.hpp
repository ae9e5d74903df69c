// SPDX-License-Identifier: GPL-3.0-or-later
// Image files, read and proved.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "rt_core/image/view.hpp"

namespace palpate::cli {

/// An image file in memory of our own, validated. A file mapping would do without the copy, but
/// what has been proved would then hold only until someone writes to the file, and a file cut short
/// under a running loop would kill it.
class ImageFile {
 public:
  /// Reads the whole file. Throws Failure(kRefused), naming file, reason and fix: not readable,
  /// not a regular file, or refused by validate().
  explicit ImageFile(const std::filesystem::path& file);

  /// Both live as long as this object, also when it is moved.
  [[nodiscard]] const ImageView& view() const { return view_; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return {memory_.get(), size_}; }

 private:
  struct Free {
    void operator()(std::byte* memory) const;
  };
  std::unique_ptr<std::byte, Free> memory_;
  std::size_t size_ = 0;
  ImageView view_;
};

}  // namespace palpate::cli

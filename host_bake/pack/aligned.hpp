// SPDX-License-Identifier: GPL-3.0-or-later
// Image bytes on the boundary that validate() and the engine need.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "rt_core/image/format.hpp"

namespace palpate::bake {

/// A copy of bytes whose first one is on a 64-byte boundary.
class AlignedCopy {
 public:
  explicit AlignedCopy(std::span<const std::byte> from)
      : lines_((from.size() + image::kAlignment - 1) / image::kAlignment), size_(from.size()) {
    if (size_ > 0) std::memcpy(lines_.data(), from.data(), size_);
  }
  [[nodiscard]] std::span<const std::byte> bytes() const {
    return std::as_bytes(std::span(lines_)).first(size_);
  }
  [[nodiscard]] std::span<std::byte> bytes() {
    return std::as_writable_bytes(std::span(lines_)).first(size_);
  }

 private:
  struct alignas(image::kAlignment) Line {
    std::byte bytes[image::kAlignment];
  };
  std::vector<Line> lines_;
  std::size_t size_;
};

}  // namespace palpate::bake

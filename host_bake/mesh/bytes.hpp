// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers out of binary files, never past the end.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include "host_bake/base/error.hpp"

namespace palpate::bake {

class Bytes {
 public:
  Bytes(std::string_view bytes, std::string file, std::endian order)
      : bytes_(bytes), file_(std::move(file)), order_(order) {}

  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

  /// Throws InputRefused where the file ends first.
  template <typename T>
  T read() {
    require(sizeof(T));
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  void skip(std::size_t count) {
    require(count);
    at_ += count;
  }

  /// Throws InputRefused unless `count` things of at least `each` bytes are left.
  void require(std::size_t count, std::size_t each = 1) const {
    if (each != 0 && count > left() / each) refuse_cut();
  }

 private:
  [[noreturn]] void refuse_cut() const {
    throw InputRefused("the file is cut or its counts are wrong", file_,
                       "copy or export the mesh again");
  }

  std::string_view bytes_;
  std::string file_;
  std::endian order_;
  std::size_t at_ = 0;
};

}  // namespace palpate::bake

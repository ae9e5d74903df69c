// SPDX-License-Identifier: Apache-2.0
// palpate.Image: a baked image, used in place.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "arrays.hpp"

namespace palpate::python {

class Image {
 public:
  /// Maps a file and proves it. Throws OSError with the file's name, Refused.
  explicit Image(const py::object& path);
  /// Bytes in memory: used in place where they lie on a 64-byte boundary, else copied.
  static std::shared_ptr<Image> from_bytes(const py::buffer& bytes);

  [[nodiscard]] const palpate_image& view() const noexcept { return view_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  explicit Image(const py::buffer& bytes);
  void prove();

  std::string name_;
  std::shared_ptr<const void> memory_;  ///< mapping, copy, or another object's buffer
  std::size_t size_ = 0;
  palpate_image view_{};
};

}  // namespace palpate::python

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/png.hpp"

#include <png.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace palpate::picture {
namespace {

// One call for the size (memory is null), one for the bytes.
void write(png_image& head, void* memory, png_alloc_size_t& size, const Raster& raster) {
  if (png_image_write_to_memory(&head, memory, &size, 0, raster.colours.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("libpng: ") + head.message);
  }
}

}  // namespace

std::vector<std::byte> to_png(const Raster& raster) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  head.width = static_cast<std::uint32_t>(raster.width);
  head.height = static_cast<std::uint32_t>(raster.height);
  head.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  write(head, nullptr, size, raster);
  std::vector<std::byte> bytes(size);
  write(head, bytes.data(), size, raster);
  bytes.resize(size);
  return bytes;
}

}  // namespace palpate::picture

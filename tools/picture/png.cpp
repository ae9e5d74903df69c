// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/png.hpp"

#include <png.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "tools/picture/indexed.hpp"

namespace palpate::picture {
namespace {

// One call for the size (memory is null), one for the bytes.
void write(png_image& head, void* memory, png_alloc_size_t& size, const Indexed& picture) {
  if (png_image_write_to_memory(&head, memory, &size, 0, picture.indices.data(), 0,
                                picture.palette.data()) == 0) {
    throw std::runtime_error(std::string("libpng: ") + head.message);
  }
}

}  // namespace

std::vector<std::byte> to_png(const Raster& raster) {
  const Indexed picture = indexed(raster);
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  head.width = static_cast<std::uint32_t>(raster.width);
  head.height = static_cast<std::uint32_t>(raster.height);
  head.format = PNG_FORMAT_RGB_COLORMAP;
  head.colormap_entries = static_cast<std::uint32_t>(picture.palette.size());
  png_alloc_size_t size = 0;
  write(head, nullptr, size, picture);
  std::vector<std::byte> bytes(size);
  write(head, bytes.data(), size, picture);
  bytes.resize(size);
  return bytes;
}

}  // namespace palpate::picture

// SPDX-License-Identifier: Apache-2.0
// Components of a body's surface: triangles joined by edges, each known by the first of its own.
#pragma once

#include <cstdint>

#include "rt_core/image/view.hpp"

namespace palpate::test {

/// Whether the image tells its components apart, as it does since format 1.5.
inline bool tells_components(const ImageView& image) noexcept {
  return image.header->source_components == 1 || image.region_triangles[0].component != 0;
}

/// The first triangle of a triangle's component; 0 where there is one. O(1)
inline std::uint32_t first_of_component(const ImageView& image, std::uint32_t triangle) noexcept {
  const std::uint32_t named = image.region_triangles[triangle].component;
  return named > triangle ? triangle : named;
}

/// @param first  of a component; that of the first one is 0
/// @return that of the next one, kNone after the last. O(1)
inline std::uint32_t next_component(const ImageView& image, std::uint32_t first) noexcept {
  const std::uint32_t named = image.region_triangles[first].component;
  return named > first ? named : image::kNone;
}

}  // namespace palpate::test

// SPDX-License-Identifier: Apache-2.0
// A convex hull as the convex queries see it: borrowed memory, usually inside an image.
#pragma once

#include <cstdint>

#include "rt_core/image/format.hpp"

namespace palpate::convex {

struct Hull {
  const image::Vertex* vertices = nullptr;    ///< [count] extreme points, hull coordinates (radius 1)
  std::uint32_t count = 0;                    ///< >= 1
  const std::uint32_t* starts = nullptr;      ///< [count + 1] into neighbours, or null: no adjacency
  const std::uint32_t* neighbours = nullptr;  ///< vertex indices; each list's vertices are joined to its vertex by a hull edge
  double scale = 1;                           ///< > 0; a point of the hull is scale * position
};

}  // namespace palpate::convex

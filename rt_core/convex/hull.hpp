// SPDX-License-Identifier: Apache-2.0
// A convex hull as the convex queries see it: borrowed memory, usually inside an image.
#pragma once

#include <cstdint>

#include "rt_core/image/format.hpp"

namespace palpate::convex {

struct Hull {
  /// [count] extreme points, hull coordinates: within image::kMaxNorm of the origin, finite.
  const image::Vertex* vertices = nullptr;
  std::uint32_t count = 0;  ///< >= 1
  /// [count + 1] into neighbours, or null: no adjacency, every support search scans all vertices.
  const std::uint32_t* starts = nullptr;
  /// Vertex indices; each list's vertices are joined to its vertex by a hull edge, none is missing.
  const std::uint32_t* neighbours = nullptr;
  double scale = 1;  ///< > 0; a point of the hull is scale * position
};

}  // namespace palpate::convex

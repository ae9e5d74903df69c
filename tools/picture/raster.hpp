// SPDX-License-Identifier: GPL-3.0-or-later
// A picture in memory with a depth buffer, and triangles drawn into it. Pixel (0, 0) is the upper
// left one; x runs right, y down; a pixel's centre is at its column and row plus one half.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "tools/picture/colour.hpp"

namespace palpate::picture {

/// A corner of a triangle. Of two surfaces the one with the larger `nearness` is seen.
struct Corner {
  double x = 0, y = 0;  ///< pixels, within +-kMaxPixels
  double nearness = 0;  ///< finite
};

inline constexpr double kMaxPixels = 1e6;

struct Raster {
  /// White and infinitely far. @param width, height  at least 1
  Raster(int width_, int height_);

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] Rgb& at(int x, int y) { return colours[index(x, y)]; }
  [[nodiscard]] Rgb at(int x, int y) const { return colours[index(x, y)]; }

  int width, height;
  std::vector<Rgb> colours;     ///< width * height, row after row
  std::vector<float> nearness;  ///< likewise
};

struct Paint {
  Rgb face;
  Rgb edge;
  double edge_px = 0;  ///< pixels whose centres are no farther from an edge get its colour
};

/// Draws what is nearer than what is there; on ties the first stays. Covers the pixels whose
/// centres are in the triangle or on its border, whichever way round its corners go: corners are
/// rounded to 1/16 pixel and the rest of the test is exact, so that triangles that share an edge
/// leave no gap. A triangle without area covers nothing. O(pixels of its bounding box).
void fill_triangle(Raster& raster, const std::array<Corner, 3>& corners, const Paint& paint);

/// Means of `factor` by `factor` pixels; what is left over at the right and below is cut off.
/// Nearness is not kept. @param factor  1 to the lesser of width and height
[[nodiscard]] Raster shrink(const Raster& raster, int factor);

/// Copies the colours of `piece` to where its upper left pixel becomes (left, top). It must fit.
void paste(Raster& raster, const Raster& piece, int left, int top);

}  // namespace palpate::picture

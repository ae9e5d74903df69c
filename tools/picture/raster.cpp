// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/raster.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace palpate::picture {
namespace {

constexpr std::int64_t kSub = 16;  // steps a pixel

struct SubPoint {
  std::int64_t x = 0, y = 0;
};

SubPoint snapped(const Corner& c) {
  assert(std::abs(c.x) <= kMaxPixels && std::abs(c.y) <= kMaxPixels);
  return {std::llround(c.x * double{kSub}), std::llround(c.y * double{kSub})};
}

// Twice the area of a, b, p. Exact: 2^25 by 2^25 at most.
std::int64_t area_2(SubPoint a, SubPoint b, SubPoint p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

struct Range {
  int first, last;  // empty where last < first
};

// The pixels of a row or a column whose centres may lie between the least and the largest value.
Range pixels(std::int64_t a, std::int64_t b, std::int64_t c, int size) {
  const auto floor_div = [](std::int64_t v) { return (v - (v % kSub + kSub) % kSub) / kSub; };
  const std::int64_t first = std::max<std::int64_t>(floor_div(std::min({a, b, c})), 0);
  const std::int64_t last = std::min<std::int64_t>(floor_div(std::max({a, b, c})), size - 1);
  return {static_cast<int>(std::min<std::int64_t>(first, size)),
          static_cast<int>(std::max<std::int64_t>(last, -1))};
}

double length(SubPoint a, SubPoint b) {
  return std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
}

}  // namespace

Raster::Raster(int width_, int height_) : width(width_), height(height_) {
  assert(width > 0 && height > 0);
  const std::size_t size = index(0, height);
  colours.assign(size, kWhite);
  nearness.assign(size, -std::numeric_limits<float>::infinity());
}

void fill_triangle(Raster& raster, const std::array<Corner, 3>& corners, const Paint& paint) {
  std::array<SubPoint, 3> p = {snapped(corners[0]), snapped(corners[1]), snapped(corners[2])};
  std::array<double, 3> near = {corners[0].nearness, corners[1].nearness, corners[2].nearness};
  std::int64_t area = area_2(p[0], p[1], p[2]);
  if (area == 0) return;
  if (area < 0) {
    std::swap(p[1], p[2]);
    std::swap(near[1], near[2]);
    area = -area;
  }
  const std::array<double, 3> lengths = {length(p[1], p[2]), length(p[2], p[0]),
                                         length(p[0], p[1])};
  const double edge = paint.edge_px * double{kSub};
  const Range columns = pixels(p[0].x, p[1].x, p[2].x, raster.width);
  const Range rows = pixels(p[0].y, p[1].y, p[2].y, raster.height);
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const SubPoint centre = {kSub * x + kSub / 2, kSub * y + kSub / 2};
      const std::array<std::int64_t, 3> to = {
          area_2(p[1], p[2], centre), area_2(p[2], p[0], centre), area_2(p[0], p[1], centre)};
      if (to[0] < 0 || to[1] < 0 || to[2] < 0) continue;
      double nearness = 0, distance = edge + 1;
      for (std::size_t i = 0; i < 3; ++i) {
        nearness += static_cast<double>(to[i]) * near[i] / static_cast<double>(area);
        distance = std::min(distance, static_cast<double>(to[i]) / lengths[i]);
      }
      float& seen = raster.nearness[raster.index(x, y)];
      if (static_cast<float>(nearness) <= seen) continue;
      seen = static_cast<float>(nearness);
      raster.at(x, y) = edge > 0 && distance <= edge ? paint.edge : paint.face;
    }
  }
}

Raster shrink(const Raster& raster, int factor) {
  Raster out(raster.width / factor, raster.height / factor);
  const int count = factor * factor;
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      int r = count / 2, g = r, b = r;
      for (int i = 0; i < count; ++i) {
        const Rgb c = raster.at(factor * x + i % factor, factor * y + i / factor);
        r += c.r;
        g += c.g;
        b += c.b;
      }
      out.at(x, y) = {static_cast<std::uint8_t>(r / count), static_cast<std::uint8_t>(g / count),
                      static_cast<std::uint8_t>(b / count)};
    }
  }
  return out;
}

void paste(Raster& raster, const Raster& piece, int left, int top) {
  assert(left >= 0 && left + piece.width <= raster.width);
  assert(top >= 0 && top + piece.height <= raster.height);
  for (int y = 0; y < piece.height; ++y) {
    for (int x = 0; x < piece.width; ++x) raster.at(left + x, top + y) = piece.at(x, y);
  }
}

}  // namespace palpate::picture

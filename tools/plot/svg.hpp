// SPDX-License-Identifier: GPL-3.0-or-later
// Plots as SVG text: panels above one another, each with lines or points.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate::plot {

enum class Mark {
  line,   ///< consecutive points are joined
  point,  ///< a dot each
};

struct Series {
  std::string name;  ///< for the legend; empty: not in it
  Mark mark = Mark::line;
  std::vector<std::pair<double, double>>
      points;  ///< not finite, or not positive on a log axis: left out
};

struct Axis {
  std::string title;
  bool log = false;
};

struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Series> series;  ///< the n-th has the n-th colour
};

/// A whole SVG file, 760 pixels wide, readable on light and dark grounds. Ranges fit the points,
/// and a linear axis of positive values begins at 0. A panel without points has axes only.
[[nodiscard]] std::string to_svg(std::span<const Panel> panels);

}  // namespace palpate::plot

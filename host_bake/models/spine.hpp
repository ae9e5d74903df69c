// SPDX-License-Identifier: GPL-3.0-or-later
// A plane curve given by its heading, for bodies swept along it (a dental arch, a club).
#pragma once

#include <functional>
#include <vector>

namespace palpate::bake {

/// A point of the curve and the unit tangent there; the normal to the left of the tangent is (-ty,
/// tx).
struct SpinePoint {
  double x = 0, y = 0, tx = 1, ty = 0;
};

class Spine {
 public:
  /// `heading_turns(s)`: direction of the tangent at arc length s in [0, length], smooth. The curve
  /// starts at the origin.
  Spine(std::function<double(double s)> heading_turns, double length);

  /// s in [0, length]. Error below 1e-9 of the length for headings that turn once or less.
  [[nodiscard]] SpinePoint at(double s) const;

 private:
  struct Place {
    double x, y;
  };
  [[nodiscard]] Place advance(Place from, double s0, double s1) const;

  std::function<double(double)> heading_turns_;
  double step_;
  std::vector<Place> places_;
};

}  // namespace palpate::bake

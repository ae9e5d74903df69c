// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/models/spine.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "host_bake/models/trig.hpp"

namespace palpate::bake {
namespace {
constexpr std::size_t kSteps = 256;
}

Spine::Spine(std::function<double(double)> heading_turns, double length)
    : heading_turns_(std::move(heading_turns)), step_(length / kSteps) {
  places_.push_back({0.0, 0.0});
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double s = step_ * static_cast<double>(i);
    places_.push_back(advance(places_.back(), s, s + step_));
  }
}

SpinePoint Spine::at(double s) const {
  const double steps = std::clamp(s / step_, 0.0, static_cast<double>(kSteps));
  const auto i = static_cast<std::size_t>(steps);
  const Place p = advance(places_[i], step_ * static_cast<double>(i), s);
  const double heading = heading_turns_(s);
  return {p.x, p.y, cos_turns(heading), sin_turns(heading)};
}

/// Simpson's rule over one step or a part of it.
Spine::Place Spine::advance(Place from, double s0, double s1) const {
  const double h0 = heading_turns_(s0);
  const double h1 = heading_turns_(0.5 * (s0 + s1));
  const double h2 = heading_turns_(s1);
  const double sixth = (s1 - s0) / 6.0;
  return {from.x + sixth * (cos_turns(h0) + 4.0 * cos_turns(h1) + cos_turns(h2)),
          from.y + sixth * (sin_turns(h0) + 4.0 * sin_turns(h1) + sin_turns(h2))};
}

}  // namespace palpate::bake

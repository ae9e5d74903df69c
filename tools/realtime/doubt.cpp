// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/doubt.hpp"

#include <algorithm>

namespace palpate::realtime {

void UsualShare::note(double share) noexcept {
  const double counts = std::min({share, 1.0, kMostTimes * usual_ + kMostMore});
  ticks_ = std::min(ticks_ + 1, kMemory);
  usual_ += (counts - usual_) / ticks_;
}

Vec3d Doubtful::follow(const Vec3d& told, const Change& change) noexcept {
  const bool touches = squared_norm(told) + squared_norm(told_) > 0;
  if (touches && change.motion > 0) usual_.note(norm(told - told_) / change.motion);
  // Where all motion counts, contacts come and go: by up to twice as much.
  const double usual = usual_.now() * (1 + usual_.now()) * change.motion;
  const double step = change.certain + usual + change.least;
  const Vec3d way = told - believed_;
  const double length = norm(way);
  believed_ = length > step ? believed_ + (step / length) * way : told;
  told_ = told;
  return believed_;
}

}  // namespace palpate::realtime

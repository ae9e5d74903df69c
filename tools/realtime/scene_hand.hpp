// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated hand of a scene's [mock].
#pragma once

#include "config/scene.hpp"
#include "hal/mock/hand.hpp"

namespace palpate::realtime {

[[nodiscard]] hal::mock::HandParameters hand_of(const config::Scene& scene);

}  // namespace palpate::realtime

// SPDX-License-Identifier: GPL-3.0-or-later
// A motion for any two bodies: down, touch, slide, up.
#pragma once

#include <string>

#include "config/scene.hpp"
#include "host_bake/base/error.hpp"
#include "tools/palpate/new_scene.hpp"

namespace palpate::cli {

/// POSES.csv of the tool: for a quarter of the time down from where it stands until it is pressed,
/// then to one side, to the other and back, and up again. A row every 10 ms.
/// @param scene  that `made` tells of
std::string touch_motion(const config::Scene& scene, const NewScene& made, double seconds,
                         const bake::Progress& progress);

}  // namespace palpate::cli

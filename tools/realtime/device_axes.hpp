// SPDX-License-Identifier: GPL-3.0-or-later
// A loop for the axes that a device has.
#pragma once

#include "hal/device.hpp"
#include "tools/realtime/loop.hpp"

namespace palpate::realtime {

/// Takes out of the settings what the device cannot do: force and torque beyond its own, torque
/// altogether where it renders force only, the orientation where it senses positions only.
///
/// Without torque the force is what a device of six axes would get at the same pose: nothing of the
/// torque is sent, and none of it counts in the limits of power or in what passivity control takes
/// back. @param orientation  of the tool, where the device does not sense it; unit quaternion
void fit_to(const hal::Capabilities& device, const Quat& orientation, LoopSettings& settings);

}  // namespace palpate::realtime

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/device_axes.hpp"

#include <algorithm>

namespace palpate::realtime {

void fit_to(const hal::Capabilities& device, const Quat& orientation, LoopSettings& settings) {
  SafetySettings& safety = settings.safety;
  safety.max_force_N = std::min(safety.max_force_N, device.max_force_N);
  safety.max_torque_Nm = std::min(safety.max_torque_Nm, device.max_torque_Nm);
  if (!device.renders_torque()) {
    safety.max_torque_Nm = 0;
    settings.passivity_limits.damper_Nm_s_per_rad = 0;
  }
  if (!device.senses_orientation()) settings.fixed_orientation = orientation;
}

}  // namespace palpate::realtime

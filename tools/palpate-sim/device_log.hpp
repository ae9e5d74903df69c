// SPDX-License-Identifier: GPL-3.0-or-later
// What a simulated device does, a line a change, with the time of day.
#pragma once

#include "hal/simulator/open_device.hpp"

namespace palpate::sim {

class DeviceLog {
 public:
  /// @param device  outlives this; null: there is nothing to log
  explicit DeviceLog(const hal::simulator::OpenDevice* device) : device_(device) {}

  /// Called after each of the device's periods.
  void look();

 private:
  const hal::simulator::OpenDevice* device_;
  bool any_ = false;
  hal::protocol::Mode mode_ = hal::protocol::Mode::idle;
  bool force_ = false;
};

}  // namespace palpate::sim

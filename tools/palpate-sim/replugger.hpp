// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated device that restarts leaves the bus as a real one does. Where this machine's kernel
// had it, it gets it again: nobody else would notice that it is back.
#pragma once

#include <cstdint>

#include "hal/simulator/simulated_device.hpp"
#include "hal/usbip/server.hpp"
#include "hal/usbip/vhci.hpp"

namespace palpate::sim {

class Replugger {
 public:
  /// Both must outlive this.
  Replugger(hal::usbip::Server& server, const hal::simulator::SimulatedDevice& device)
      : server_(server), device_(device) {}

  /// Called now and then.
  void look();

 private:
  void plug_in();

  hal::usbip::Server& server_;
  const hal::simulator::SimulatedDevice& device_;
  hal::usbip::Vhci vhci_;
  bool plugged_in_here_ = false;
  std::uint32_t times_left_ = 0;  ///< by the device, when it was looked at last
};

}  // namespace palpate::sim

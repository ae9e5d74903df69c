// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate-sim/replugger.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>

namespace palpate::sim {

void Replugger::look() {
  const hal::simulator::Presence presence = device_.presence();
  if (server_.attached() && presence.times_left == times_left_) {
    // Not again and again: that would take time from the device's periods.
    if (!plugged_in_here_) plugged_in_here_ = vhci_.has_device();
  } else if (!server_.attached() && presence.on_bus) {
    // Not after somebody has detached it.
    if (plugged_in_here_ && presence.times_left != times_left_) plug_in();
    plugged_in_here_ = false;
    times_left_ = presence.times_left;
  }
}

void Replugger::plug_in() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return;
  if (vhci_.attach(ends[1], device_.descriptors().speed)) {
    server_.adopt_owner(ends[0]);
  } else {
    ::close(ends[0]);
    std::printf("the device is back; attach it again\n");
    std::fflush(stdout);
  }
  ::close(ends[1]);
}

}  // namespace palpate::sim

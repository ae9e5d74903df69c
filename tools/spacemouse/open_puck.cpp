// SPDX-License-Identifier: GPL-3.0-or-later
// The one file that knows libspnav, whose header brings the names of X11.
#include "tools/spacemouse/puck.hpp"

#ifdef PALPATE_SPNAV
#include <poll.h>
#include <spnav.h>
#endif

namespace palpate::spacemouse {

#ifdef PALPATE_SPNAV
namespace {

/// What has arrived stays in libspnav's own queue only while it waits for answers, of which none is
/// asked for here: so its socket says whether there is more.
class SpnavPuck final : public Puck {
 public:
  SpnavPuck() = default;
  ~SpnavPuck() override { spnav_close(); }
  SpnavPuck(const SpnavPuck&) = delete;
  SpnavPuck& operator=(const SpnavPuck&) = delete;
  SpnavPuck(SpnavPuck&&) = delete;
  SpnavPuck& operator=(SpnavPuck&&) = delete;

  Heard next(Deflection& out, std::chrono::milliseconds most) override {
    pollfd file{spnav_fd(), POLLIN, 0};
    if (::poll(&file, 1, static_cast<int>(most.count())) <= 0) return Heard::nothing;
    spnav_event event{};
    const int type = spnav_poll_event(&event);
    if (type == 0) return (file.revents & (POLLHUP | POLLERR)) != 0 ? Heard::gone : Heard::nothing;
    if (type == SPNAV_EVENT_BUTTON && event.button.press != 0) return Heard::button;
    if (type != SPNAV_EVENT_MOTION) return Heard::nothing;
    // Its axes are right, up and away, with turns about right, up and, the other way, towards.
    const spnav_event_motion& m = event.motion;
    out = {{m.x, m.z, m.y}, {m.rx, m.rz, m.ry}};
    return Heard::deflection;
  }
};

}  // namespace

std::variant<std::unique_ptr<Puck>, hal::DeviceProblem> open_puck() {
  if (spnav_open() == -1) {
    return hal::DeviceProblem{"open", "the SpaceMouse daemon does not answer",
                              "install the package spacenavd and start it (sudo systemctl start "
                              "spacenavd)"};
  }
  return std::make_unique<SpnavPuck>();
}
#else
std::variant<std::unique_ptr<Puck>, hal::DeviceProblem> open_puck() {
  return hal::DeviceProblem{"open", "this build knows no SpaceMouse",
                            "install libspnav-dev and build again"};
}
#endif

}  // namespace palpate::spacemouse

// SPDX-License-Identifier: GPL-3.0-or-later
// A mouse of six axes (SpaceMouse): a puck that springs back, so that it says how fast and which
// way.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <variant>

#include "hal/device.hpp"

namespace palpate::spacemouse {

/// How far the puck is pushed and turned, about 350 at most; 0 at rest. As its user sees it: right,
/// away, up, and turns about these by the right hand.
struct Deflection {
  std::array<int, 3> push{}, turn{};
};

enum class Heard : std::uint8_t {
  nothing,
  deflection,
  button,  ///< one was pressed
  gone     ///< whatever said so will say nothing more
};

class Puck {
 public:
  virtual ~Puck() = default;
  Puck() = default;
  Puck(const Puck&) = delete;
  Puck& operator=(const Puck&) = delete;
  Puck(Puck&&) = delete;
  Puck& operator=(Puck&&) = delete;

  /// The next event, waited for so long at most. @param out  replaced by a deflection alone
  [[nodiscard]] virtual Heard next(Deflection& out, std::chrono::milliseconds most) = 0;
};

/// The SpaceMouse of this machine, by libspnav from the daemon spacenavd; one at a time. The
/// problem where this build has no libspnav or the daemon does not answer.
[[nodiscard]] std::variant<std::unique_ptr<Puck>, hal::DeviceProblem> open_puck();

}  // namespace palpate::spacemouse

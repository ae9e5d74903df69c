// SPDX-License-Identifier: GPL-3.0-or-later
// Errors and progress of the baker.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace palpate::bake {

/// An input is refused. The message reads `WHAT: WHERE: HOW TO FIX`; the command line prints it
/// after `palpate: error: ` and exits with 3.
struct InputRefused : std::runtime_error {
  InputRefused(const std::string& what, const std::string& where, const std::string& fix)
      : std::runtime_error(what + ": " + where + ": " + fix) {}
};

/// Called now and then with the stage's name and its share done in [0, 1]; from one thread at a
/// time. May be empty.
using Progress = std::function<void(std::string_view stage, double done)>;

}  // namespace palpate::bake

// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the kernel serves haptic devices on USB in time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/realtime/host_checks.hpp"

namespace palpate::realtime {

/// @param root    of the file system  @param set_up  the command that readies a host
[[nodiscard]] std::vector<HostCheck> usb_checks(const std::filesystem::path& root,
                                                const std::string& set_up);

}  // namespace palpate::realtime

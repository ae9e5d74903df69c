// SPDX-License-Identifier: GPL-3.0-or-later
// Where haptic devices are plugged in, and whether they or their bus may be put to sleep.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/realtime/host_checks.hpp"

namespace palpate::realtime {

/// @param root    of the file system  @param set_up  the command that readies a host
[[nodiscard]] std::vector<HostCheck> usb_device_checks(const std::filesystem::path& root,
                                                       const std::string& set_up);

[[nodiscard]] bool udev_rule_installed(const std::filesystem::path& root);

}  // namespace palpate::realtime

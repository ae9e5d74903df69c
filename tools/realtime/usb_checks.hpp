// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the kernel serves haptic devices on USB in time.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/realtime/host_checks.hpp"

namespace palpate::realtime {

[[nodiscard]] std::vector<HostCheck> usb_checks(const std::filesystem::path& root);

}  // namespace palpate::realtime

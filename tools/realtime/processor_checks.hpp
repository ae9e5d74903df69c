// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a processor is kept for the loop.
#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "tools/realtime/host_checks.hpp"

namespace palpate::realtime {

[[nodiscard]] std::vector<HostCheck> processor_checks(const std::filesystem::path& root);

/// Processors that nothing but what asks for them runs on.
[[nodiscard]] std::set<int> isolated_processors(const std::filesystem::path& root);

}  // namespace palpate::realtime

// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate replay --profile`: what the ticks were made of.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "rt_core/counters.hpp"

namespace palpate::cli {

/// A line for each stage of a tick (mean time) and each kind of work (mean count), and the pools'
/// high-water marks beside their sizes.
std::string profile_text(const Counters& counters, const Limits& limits);

/// The same as sums: {"ticks", "stage_ns": {...}, ..., "most_nodes", ...}.
nlohmann::ordered_json profile_json(const Counters& counters);

}  // namespace palpate::cli

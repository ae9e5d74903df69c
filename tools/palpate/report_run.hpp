// SPDX-License-Identifier: GPL-3.0-or-later
// What only the report of a run has: what was sent, what came back, and when something went wrong.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/palpate/report_frames.hpp"
#include "tools/palpate/report_input.hpp"

namespace palpate::cli {

/// Marks of one report at most; the first ones are kept.
inline constexpr std::size_t kMaxMarks = 1000;

/// @param input  of a run
nlohmann::ordered_json report_run_json(const ReportInput& input, const Frames& frames);

}  // namespace palpate::cli

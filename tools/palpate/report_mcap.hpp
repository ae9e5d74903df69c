// SPDX-License-Identifier: GPL-3.0-or-later
// A trace as MCAP, for Foxglove and whatever else reads that (docs/REPORT.md, "MCAP").
#pragma once

#include <filesystem>

#include "tools/palpate/trace_file.hpp"

namespace palpate::cli {

/// Writes the file whole or not at all. Bodies are shown where the scene and its images can be
/// opened; else the reason is printed, unless quiet.
/// @param scene  in place of the trace's own, and then has to be right; may be empty
void write_mcap(const Trace& trace, const std::filesystem::path& scene,
                const std::filesystem::path& target, bool quiet);

}  // namespace palpate::cli

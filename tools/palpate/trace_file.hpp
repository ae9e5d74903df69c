// SPDX-License-Identifier: GPL-3.0-or-later
// A trace of a run, read (docs/REALTIME.md, "Trace format").
#pragma once

#include <filesystem>
#include <vector>

#include "tools/realtime/trace.hpp"

namespace palpate::cli {

struct Trace {
  realtime::TraceHeader header;
  std::filesystem::path scene;
  std::vector<realtime::TraceRecord> records;  ///< at least one
};

/// Throws Failure(kRefused): not there, no trace, of another version, cut short, without ticks.
Trace read_trace(const std::filesystem::path& file);

}  // namespace palpate::cli
